// When the filter of GnssStage is dropped, doubted or started over.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/earth/ellipsoid.h"
#include "core/gnss/point_solution.h"
#include "core/navigator/epoch_report.h"
#include "core/navigator/gnss_stage.h"
#include "core/navigator/solution.h"

namespace leonav {
namespace {

constexpr int kMinToJudge = 4;             // codes or Dopplers
constexpr int kBeyondDoubt = 3;            // times those thrown out
constexpr int kMinResetRedundancy = 2;     // of a point solution that overthrows a running filter
constexpr double kUselessSigma_m = 500.0;  // beyond, the filter adds nothing to a point solution
constexpr double kLostSigma_m = 1e5;       // likewise, with carrier arcs
constexpr double kRelapse_s = 60.0;  // a second reset this soon: the attitude is to blame as well
constexpr double kMinResetHeadingSigma = 0.1;                        // rad
constexpr double kMaxLockedOut_m = 250.0, kMaxLockedOut_m_s = 30.0;  // it is made unsure by at most
constexpr double kLockOutRelapse_s = 90.0;  // locked out once more this soon
// A place all codes agree on, without a contradiction, against the filter's.
constexpr int kMinCodesToMove = 7;
constexpr int kMinMoveRedundancy = 3;
constexpr double kInconsistent = 1.5;
constexpr double kElsewhere = 2.0;  // sigmas of one point solution, in the mean of many
constexpr double kElsewhereOfFilter = 5.0;
constexpr double kMeanOver_s = 15.0;
constexpr double kElsewhereEnough = 120.0;  // 30 s of eight codes of one system
constexpr double kMostTrust = 480.0;        // beyond, more past says no more
constexpr double kLongestInterval_s = 10.0;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Satellites beyond what a position and one clock per time base need.
int redundancy(const PointSolution& point) {
  int bases = 0;
  for (const double clock_m : point.clock_m) bases += std::isfinite(clock_m) ? 1 : 0;
  return point.satellites - 3 - bases;
}

// Any few codes agree with some position: most must, for it to be more than chance.
bool most_codes_agree(const MeasurementEpoch& epoch) {
  int offered = 0, used = 0;
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCode) continue;
    ++offered;
    const Reason reason = measurement.reason;
    used += reason == Reason::kUsed || reason == Reason::kDownweighted ? 1 : 0;
  }
  return 3 * used >= 2 * offered;
}

// None is thrown out, and hardly one doubted.
bool all_codes_agree(const MeasurementEpoch& epoch) {
  int offered = 0, doubted = 0;
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCode) continue;
    if (measurement.reason == Reason::kOutlier) return false;
    offered += measurement.reason == Reason::kUsed ? 1 : 0;
    doubted += measurement.reason == Reason::kDownweighted ? 1 : 0;
  }
  return 4 * doubted <= offered;
}

int thrown_out(const MeasurementEpoch& epoch, Observable observable) {
  return static_cast<int>(std::count_if(
      epoch.measurements.begin(), epoch.measurements.end(), [&](const Measurement& m) {
        return m.observable == observable && m.reason == Reason::kOutlier;
      }));
}

Eigen::Matrix3d widened(const EkfCovariance& covariance, int first, double sigma) {
  return covariance.block<3, 3>(first, first) + sigma * sigma * Eigen::Matrix3d::Identity();
}

}  // namespace

// A filter whose numbers have overflowed is of no more use to anybody, its attitude included.
void GnssStage::drop_broken_filter(GpsTime time) {
  if (ekf_.initialized() && !ekf_.is_finite()) drop_filter(time, ResetCause::kNotFinite, 0.0);
}

void GnssStage::drop_filter(GpsTime time, ResetCause cause, double value) {
  ekf_.reset();
  carriers_.forget_position();
  alignment_.reset();
  gnss_used_ = false;
  forget_judgements();
  outage_watch_.reset();
  last_reset_time_ = time;
  events_.emit(EventKind::kFilterReset, static_cast<std::uint8_t>(cause), value, time);
}

// A velocity to judge the filter's heading by: more satellites of one opinion than it needs, and
// many more than there are of another. Leaves no trace.
bool GnssStage::solve_beyond_doubt(const EpochWork& work, PointSolution* point) {
  std::swap(measurements_, check_measurements_);
  const bool solved = solve(work, ekf_.antenna_position_e(), nullptr, point) && point->has_velocity;
  const int out = std::max(thrown_out(*measurements_, Observable::kCode),
                           thrown_out(*measurements_, Observable::kDoppler));
  std::swap(measurements_, check_measurements_);
  return solved && redundancy(*point) >= std::max(kMinResetRedundancy, kBeyondDoubt * out);
}

bool GnssStage::prediction_is_useless() const {
  // Carrier arcs under way are worth more than any position of codes.
  const bool arcs = config_.ekf.use_carrier && last_gnss_time_.is_set() &&
                    seconds_between(last_epoch_time_, last_gnss_time_) <= config_.ekf.max_arc_gap_s;
  const double limit_m = arcs ? kLostSigma_m : kUselessSigma_m;
  return !ekf_.state().p_e.allFinite() || !(position_sigma() < limit_m);
}

double GnssStage::position_sigma() const {
  return norm_of_sigmas(ekf_.covariance().block<3, 3>(ekf_index::kPosition, ekf_index::kPosition));
}

// A filter that is less right than it says, for long, is somebody's business even where no
// measurement stands out.
void GnssStage::watch_consistency(const EpochWork& work, const EkfUpdateResult& result) {
  const std::array<double, 2> ratios = {result.code_ratio, result.doppler_ratio};
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    if (consistency_[i].add(ratios[i]))
      events_.emit(EventKind::kImprobable, static_cast<std::uint8_t>(i), consistency_[i].mean(),
                   work.time);
  }
}

// Nothing is lost by a step that has been taken up; but whoever uses the receiver's time wants to
// know, and so does whoever wonders why arcs ended.
void GnssStage::watch_clocks(const EkfUpdateResult& result, GpsTime time) {
  const auto tell = [&](std::size_t code, double step_m) {
    if (step_m == 0.0) return;
    // Thinned, like the orbits': some receivers' clocks step every second.
    if (++clock_steps_ > 16 && clock_steps_ % 256 != 0) return;
    events_.emit(EventKind::kClockStep, static_cast<std::uint8_t>(code), step_m, time);
  };
  tell(static_cast<std::size_t>(ClockStep::kReceiver), result.clock_jump_m - result.code_step_m);
  tell(static_cast<std::size_t>(ClockStep::kCodes), result.code_step_m);
  for (std::size_t base = 0; base < kMaxTimeBases; ++base)
    tell(static_cast<std::size_t>(ClockStep::kFirstSystem) + base, result.base_step_m[base]);
}

void GnssStage::watch_usable() {
  const auto finding = usable_watch_.add({report_->satellites.data(), report_->satellites.size()});
  if (finding)
    events_.emit(EventKind::kNoneUsable, static_cast<std::uint8_t>(finding->reason),
                 finding->satellites, last_epoch_time_);
}

// One after the other, until one of them has started the filter over: `result` is of the one
// before.
void GnssStage::judge(const EpochWork& work, const EkfUpdateResult& result) {
  judge_prediction(work, result);
  if (last_reset_time_ != work.time) judge_lock_out(work, result);
  if (last_reset_time_ != work.time) judge_position(work, result);
}

// Most codes or Dopplers thrown out, epoch after epoch, is a filter that has lost its way. A point
// solution is asked before it is believed, and must have been checked itself: where it agrees with
// the filter, the measurements are to blame.
void GnssStage::judge_prediction(const EpochWork& work, const EkfUpdateResult& result) {
  const auto most = [&](int rejected, int offered) {
    return offered >= kMinToJudge && rejected >= config_.ekf.reset_ratio * offered;
  };
  const auto most_of = [&](Observable observable) {
    const auto kind = static_cast<std::size_t>(observable);
    return most(result.rejected[kind], result.offered[kind]);
  };
  const bool code = most_of(Observable::kCode);
  const bool doppler = most_of(Observable::kDoppler);
  const bool suspect = code || doppler;
  suspect_epochs_ = suspect ? suspect_epochs_ + 1 : 0;
  if (suspect_epochs_ != 1 && suspect_epochs_ < config_.ekf.reset_epochs) return;
  std::swap(measurements_, check_measurements_);
  PointSolution point;
  const bool checked = solve(work, ekf_.antenna_position_e(), &point) &&
                       redundancy(point) >= kMinResetRedundancy && most_codes_agree(*measurements_);
  if (suspect_epochs_ == 1) {
    suspect_since_ = checked ? work.time : GpsTime();
    suspect_point_ = point;
  }
  if (checked && suspect_epochs_ >= config_.ekf.reset_epochs &&
      contradicts(point, work.time, doppler)) {
    restart_from(point, work, ResetCause::kPrediction);
  }
  std::swap(measurements_, check_measurements_);
}

// A filter that began where walls made most of the codes stays there, its carriers hold it, also
// when all codes agree on another place. Against their word stands what codes have said before: the
// longer, and the more of them, the more. Counted are codes beyond those a position needs, times
// seconds.
void GnssStage::judge_position(const EpochWork& work, const EkfUpdateResult& result) {
  const auto code = static_cast<std::size_t>(Observable::kCode);
  const double passed_s = seconds_between(work.time, std::exchange(last_judged_, work.time));
  const double interval_s = std::clamp(passed_s, 0.0, kLongestInterval_s);
  if (result.offered[code] < kMinCodesToMove) return;
  if (result.rejected[code] == 0 && consistency_[0].mean() < kInconsistent) {
    const int beyond = result.offered[code] - 3 - static_cast<int>(kMaxTimeBases);
    elsewhere_ = std::max(-kMostTrust, elsewhere_ - std::max(beyond, 1) * interval_s);
    return;
  }
  PointSolution point;
  std::swap(measurements_, check_measurements_);
  const bool clear = solve(work, ekf_.antenna_position_e(), &point) &&
                     redundancy(point) >= kMinMoveRedundancy && all_codes_agree(*measurements_);
  std::swap(measurements_, check_measurements_);
  if (!clear) return;
  const double weight = redundancy(point) * interval_s;
  const Eigen::Vector3d off_e = point.p_e - ekf_.antenna_position_e();
  mean_off_e_ += std::min(1.0, interval_s / kMeanOver_s) * (off_e - mean_off_e_);
  const double limit_m = std::max(kElsewhere * norm_of_sigmas(point.covariance_p_e),
                                  kElsewhereOfFilter * position_sigma());
  const bool away = mean_off_e_.norm() > limit_m;
  elsewhere_ = std::max(-kMostTrust, elsewhere_ + (away ? weight : -weight));
  if (away && elsewhere_ > kElsewhereEnough) restart_from(point, work, ResetCause::kPrediction);
}

// Nobody can tell whether the filter or what it throws out is wrong: it goes on from where it is,
// as unsure as the two are apart. Where that has not helped, or could not and there are enough to
// start from, it gives up.
void GnssStage::judge_lock_out(const EpochWork& work, const EkfUpdateResult& result) {
  const LockOut found = lock_out_watch_.add(result, *measurements_, work.time);
  if (found == LockOut::kClocks) ekf_.forget_clocks();
  if (found != LockOut::kPosition) return;
  const bool again =
      last_lock_out_.is_set() && seconds_between(work.time, last_lock_out_) < kLockOutRelapse_s;
  const bool far = lock_out_watch_.off_m() > kMaxLockedOut_m && lock_out_watch_.enough_to_start();
  if (again || far) return drop_filter(work.time, ResetCause::kLockedOut, lock_out_watch_.off_m());
  const double off_m = std::min(lock_out_watch_.off_m(), kMaxLockedOut_m);
  last_lock_out_ = work.time;
  PointSolution own;
  own.p_e = ekf_.antenna_position_e();
  own.v_e = ekf_.antenna_velocity_e();
  own.has_velocity = true;
  own.covariance_p_e = widened(ekf_.covariance(), ekf_index::kPosition, off_m);
  own.covariance_v_e = widened(ekf_.covariance(), ekf_index::kVelocity,
                               std::min(lock_out_watch_.off_m_s(), kMaxLockedOut_m_s));
  const ClockFlags& known = ekf_.clocks_known();
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    const auto i = static_cast<Eigen::Index>(base);
    own.clock_m[base] = known.offset[base] ? ekf_.clocks().offset_m(i) : kUnknown;
    own.clock_drift_m_s[base] = known.drift[base] ? ekf_.clocks().drift_m_s(i) : kUnknown;
  }
  restart_from(own, work, ResetCause::kLockedOut);
}

// Dopplers alone could all be wrong, of a receiver that has their sign or unit wrong for one:
// position and clocks of the codes must have moved as they say, rather than as the filter does.
bool GnssStage::has_moved_as(const PointSolution& point, GpsTime time) const {
  if (!suspect_since_.is_set() || !(suspect_since_ < time)) return false;
  const double dt = seconds_between(time, suspect_since_);
  const Eigen::Vector3d moved_m_s = (point.p_e - suspect_point_.p_e) / dt;
  double from_point = (moved_m_s - point.v_e).squaredNorm();
  double from_filter = (moved_m_s - ekf_.antenna_velocity_e()).squaredNorm();
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    const double ran_m_s = (point.clock_m[base] - suspect_point_.clock_m[base]) / dt;
    const double drift_m_s = ekf_.clocks().drift_m_s(static_cast<Eigen::Index>(base));
    if (!ekf_.clocks_known().drift[base] || !std::isfinite(ran_m_s + point.clock_drift_m_s[base]))
      continue;
    from_point += std::pow(ran_m_s - point.clock_drift_m_s[base], 2);
    from_filter += std::pow(ran_m_s - drift_m_s, 2);
  }
  return from_point < from_filter;
}

// Whether the filter is elsewhere than a point solution; with `motion` also whether it moves, or
// its oscillator runs, otherwise.
bool GnssStage::contradicts(const PointSolution& point, GpsTime time, bool motion) const {
  const double distance_m = (point.p_e - ekf_.antenna_position_e()).norm();
  if (distance_m > 3.0 * norm_of_sigmas(point.covariance_p_e)) return true;
  if (!motion || !point.has_velocity) return false;
  const double limit_m_s = 3.0 * norm_of_sigmas(point.covariance_v_e);
  bool otherwise = (point.v_e - ekf_.antenna_velocity_e()).norm() > limit_m_s;
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    if (!ekf_.clocks_known().drift[base] || !std::isfinite(point.clock_drift_m_s[base])) continue;
    const double drift_m_s = ekf_.clocks().drift_m_s(static_cast<Eigen::Index>(base));
    otherwise = otherwise || std::abs(point.clock_drift_m_s[base] - drift_m_s) > limit_m_s;
  }
  return otherwise && has_moved_as(point, time);
}

// The attitude survives, less sure of its heading, unless it has just been given that chance; what
// has been learned of the IMU's errors survives with it.
void GnssStage::restart_from(const PointSolution& point, const EpochWork& work, ResetCause cause) {
  const double value_m = cause == ResetCause::kLockedOut
                             ? norm_of_sigmas(point.covariance_p_e)
                             : (point.p_e - ekf_.antenna_position_e()).norm();
  const bool relapse =
      last_reset_time_.is_set() && seconds_between(work.time, last_reset_time_) < kRelapse_s;
  const bool keep_attitude =
      ekf_.has_attitude() && !relapse && ekf_.state().q_eb.coeffs().allFinite();
  const Eigen::Quaterniond q_eb = ekf_.state().q_eb;
  const ImuErrors errors = ekf_.state().errors;
  const ImuErrorCovariance error_covariance =
      ekf_.covariance().block<12, 12>(ekf_index::kGyroBias, ekf_index::kGyroBias);
  const AttitudeWander wander = ekf_.whole_state().wander;
  EpochReport* report = report_.get();
  report_state(ekf_, report);
  Eigen::Vector3d sigma_rpy = report->solution.sigma_rpy;
  sigma_rpy.head<2>() = sigma_rpy.head<2>().cwiseMax(config_.alignment.levelling_sigma);
  sigma_rpy.z() = std::max(2.0 * sigma_rpy.z(), kMinResetHeadingSigma);

  // What a wrong attitude has taught of the vehicle's constants goes with it.
  if (relapse) ekf_.forget_constants();
  ekf_.initialize(work.time, point);
  carriers_.forget_position();
  if (keep_attitude) {
    ekf_.set_attitude(q_eb, sigma_rpy, errors, error_covariance);
    if (wander.noise > 0.0)  // it goes on settling
      ekf_.let_attitude_wander(wander.noise, seconds_between(wander.until, work.time));
  } else {
    alignment_.reset();
  }
  gnss_used_ = true;
  forget_judgements();
  last_reset_time_ = work.time;
  events_.emit(EventKind::kFilterReset, static_cast<std::uint8_t>(cause), value_m, work.time);
}

// What has been gathered for and against a filter says nothing about the next one.
void GnssStage::forget_judgements() {
  suspect_epochs_ = 0;
  lock_out_watch_.reset();
  elsewhere_ = 0.0;
  mean_off_e_.setZero();
}

}  // namespace leonav
