#include "core/navigator/gnss_stage.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/gnss/point_solution.h"
#include "core/gnss/preprocess.h"
#include "core/navigator/epoch_report.h"
#include "core/navigator/solution.h"

namespace leonav {
namespace {

constexpr int kMinSatellites = 4;
constexpr double kMaxPdop = 15.0;
constexpr double kMaxResidualRms_m = 60.0;
constexpr int kMinToJudge = 4;             // codes or Dopplers
constexpr int kMinResetRedundancy = 2;     // of a point solution that overthrows a running filter
constexpr double kUselessSigma_m = 500.0;  // beyond, the filter adds nothing to a point solution
constexpr double kRelapse_s = 60.0;  // a second reset this soon: the attitude is to blame as well
constexpr double kMinResetHeadingSigma = 0.1;  // rad

// A start has nothing to compare its measurements with but each other: it always excludes faults,
// also where the filter is told to trust everything.
RobustConfig robust_start(RobustConfig config) {
  config.enabled = true;
  return config;
}

// NaN where the covariance is no number.
double norm_of_sigmas(const Eigen::Matrix3d& covariance) {
  const double trace = covariance.trace();
  return trace < 0.0 ? 0.0 : std::sqrt(trace);
}

// Satellites beyond what a position and one clock per time base need.
int redundancy(const PointSolution& point) {
  int bases = 0;
  for (const double clock_m : point.clock_m) bases += std::isfinite(clock_m) ? 1 : 0;
  return point.satellites - 3 - bases;
}

}  // namespace

GnssStage::GnssStage(const NavigatorConfig& config, TimedMailbox<EkfUpdate>* ekf_mailbox,
                     OutputSink* sink)
    : config_(config),
      mailbox_(ekf_mailbox),
      sink_(sink),
      events_(Stage::kGnss, sink),
      inertial_(config.motion == MotionModel::kInertial),
      catalog_(config.gnss.catalog),
      ekf_(config.ekf, config.imu, config.vehicle.lever_arm_b),
      alignment_(config.alignment),
      measurements_(std::make_unique<MeasurementEpoch>()),
      check_measurements_(std::make_unique<MeasurementEpoch>()),
      report_(std::make_unique<EpochReport>()) {
  const AlignmentConfig& alignment = config_.alignment;
  if (alignment.initial_heading)
    given_heading_.tell({*alignment.initial_heading, alignment.initial_heading_sigma});
}

void GnssStage::process(const GnssWork& work) {
  if (const auto* epoch = std::get_if<EpochWork>(&work)) {
    process_epoch(*epoch);
  } else if (const auto* ephemeris = std::get_if<Ephemeris>(&work)) {
    catalog_.add(*ephemeris);
  } else if (const auto* states = std::get_if<PreciseStates>(&work)) {
    for (const PreciseState& state : *states) catalog_.add(state);
  } else if (const auto* klobuchar = std::get_if<KlobucharModel>(&work)) {
    catalog_.set_klobuchar(*klobuchar);
  } else if (const auto* antenna = std::get_if<AntennaPattern>(&work)) {
    antennas_.add(*antenna);
  } else if (const auto* command = std::get_if<Command>(&work)) {
    process_command(*command);
  }
}

void GnssStage::process_epoch(const EpochWork& work) {
  start_report(work.index, work.time, work.empty, report_.get());
  last_epoch_time_ = work.time;
  gnss_used_ = false;
  if (inertial_ && !ekf_.has_attitude()) {
    for (const ImuSample& sample : work.block) alignment_.add(sample);
  }
  ekf_.predict({work.block.data(), work.block.size()}, work.time);
  drop_broken_filter(work.time);
  if (!work.empty) use_measurements(work);
  drop_broken_filter(work.time);
  if (gnss_used_) {
    last_gnss_time_ = work.time;
    align(work);
  }
  watch_motion(work);
  report_solution(work);
  deliver(work);
  watch_orbits();
  publish(work);
}

// A filter whose numbers have overflowed is of no more use to anybody, its attitude included.
void GnssStage::drop_broken_filter(GpsTime time) {
  if (ekf_.initialized() && !ekf_.is_finite()) drop_filter(time);
}

void GnssStage::drop_filter(GpsTime time) {
  ekf_ = Ekf(config_.ekf, config_.imu, config_.vehicle.lever_arm_b);
  alignment_.reset();
  gnss_used_ = false;
  suspect_epochs_ = 0;
  last_reset_time_ = time;
  events_.emit(EventKind::kFilterReset, static_cast<std::uint8_t>(ResetCause::kNotFinite), 0.0,
               time);
}

void GnssStage::use_measurements(const EpochWork& work) {
  if (!ekf_.initialized()) {
    start_filter(work);
  } else if (prediction_is_useless()) {
    PointSolution point;
    if (solve(work, Eigen::Vector3d::Zero(), &point)) {
      restart_from(point, work, ResetCause::kOutage);
      report_point(*measurements_, true, point.p_e, report_.get());
    } else {
      report_point(*measurements_, false, Eigen::Vector3d::Zero(), report_.get());
    }
  } else {
    update_filter(work);
  }
}

// A point solution good enough to start from; its measurements stay in measurements_.
bool GnssStage::solve(const EpochWork& work, const Eigen::Vector3d& approximate_p_e,
                      PointSolution* point) {
  *point = solve_point(work.raw, catalog_, config_.gnss, robust_start(config_.ekf.robust),
                       approximate_p_e, measurements_.get(), &band_biases_);
  measurements_->index = work.index;
  return point->status == PointStatus::kOk && point->satellites >= kMinSatellites &&
         point->pdop <= kMaxPdop && point->residual_rms_m <= kMaxResidualRms_m &&
         point->p_e.allFinite() && point->covariance_p_e.allFinite();
}

bool GnssStage::start_filter(const EpochWork& work) {
  PointSolution point;
  const bool solved = solve(work, Eigen::Vector3d::Zero(), &point);
  if (solved) {
    ekf_.initialize(work.time, point);
    gnss_used_ = true;
  }
  report_point(*measurements_, solved, point.p_e, report_.get());
  return solved;
}

bool GnssStage::prediction_is_useless() const {
  const Eigen::Matrix3d covariance =
      ekf_.covariance().block<3, 3>(ekf_index::kPosition, ekf_index::kPosition);
  return !ekf_.state().p_e.allFinite() || !(norm_of_sigmas(covariance) < kUselessSigma_m);
}

void GnssStage::update_filter(const EpochWork& work) {
  preprocess(work.raw, catalog_, config_.gnss, ekf_.antenna_position_e(), measurements_.get(),
             &band_biases_);
  measurements_->index = work.index;
  const EkfUpdateResult result = ekf_.update(*measurements_);
  gnss_used_ = result.used > 0;
  report_update(*measurements_, result, ekf_.antenna_position_e(), report_.get());
  watch_consistency(work, result);
  judge_prediction(work, result);
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

// Most codes or Dopplers thrown out, epoch after epoch, is a filter that has lost its way. A point
// solution is asked before it is believed, and must have been checked itself: where it agrees with
// the filter, the measurements are to blame.
void GnssStage::judge_prediction(const EpochWork& work, const EkfUpdateResult& result) {
  const auto most = [&](int rejected, int offered) {
    return offered >= kMinToJudge && rejected >= config_.ekf.reset_ratio * offered;
  };
  const bool code = most(result.code_rejected, result.code_offered);
  const bool doppler = most(result.doppler_rejected, result.doppler_offered);
  const bool suspect = code || doppler;
  suspect_epochs_ = suspect ? suspect_epochs_ + 1 : 0;
  if (suspect_epochs_ < config_.ekf.reset_epochs) return;
  std::swap(measurements_, check_measurements_);
  PointSolution point;
  if (solve(work, ekf_.antenna_position_e(), &point) && redundancy(point) >= kMinResetRedundancy &&
      contradicts(point, doppler)) {
    restart_from(point, work, ResetCause::kPrediction);
  }
  std::swap(measurements_, check_measurements_);
}

// Whether the filter is elsewhere than a point solution; with `motion` also whether it moves, or
// its oscillator runs, otherwise.
bool GnssStage::contradicts(const PointSolution& point, bool motion) const {
  const double distance_m = (point.p_e - ekf_.antenna_position_e()).norm();
  if (distance_m > 3.0 * norm_of_sigmas(point.covariance_p_e)) return true;
  if (!motion || !point.has_velocity) return false;
  const double limit_m_s = 3.0 * norm_of_sigmas(point.covariance_v_e);
  if ((point.v_e - ekf_.antenna_velocity_e()).norm() > limit_m_s) return true;
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    if (!ekf_.clocks_known().drift[base] || !std::isfinite(point.clock_drift_m_s[base])) continue;
    const double drift_m_s = ekf_.clocks().drift_m_s(static_cast<Eigen::Index>(base));
    if (std::abs(point.clock_drift_m_s[base] - drift_m_s) > limit_m_s) return true;
  }
  return false;
}

// The attitude survives, less sure of its heading, unless it has just been given that chance; what
// has been learned of the IMU's errors survives with it.
void GnssStage::restart_from(const PointSolution& point, const EpochWork& work, ResetCause cause) {
  const double moved_m = (point.p_e - ekf_.antenna_position_e()).norm();
  const bool relapse =
      last_reset_time_.is_set() && seconds_between(work.time, last_reset_time_) < kRelapse_s;
  const bool keep_attitude =
      ekf_.has_attitude() && !relapse && ekf_.state().q_eb.coeffs().allFinite();
  const Eigen::Quaterniond q_eb = ekf_.state().q_eb;
  const ImuErrors errors = ekf_.state().errors;
  const ImuErrorCovariance error_covariance =
      ekf_.covariance().block<12, 12>(ekf_index::kGyroBias, ekf_index::kGyroBias);
  EpochReport* report = report_.get();
  report_state(ekf_, report);
  Eigen::Vector3d sigma_rpy = report->solution.sigma_rpy;
  sigma_rpy.head<2>() = sigma_rpy.head<2>().cwiseMax(config_.alignment.levelling_sigma);
  sigma_rpy.z() = std::max(2.0 * sigma_rpy.z(), kMinResetHeadingSigma);

  ekf_.initialize(work.time, point);
  if (keep_attitude) {
    ekf_.set_attitude(q_eb, sigma_rpy, errors, error_covariance);
  } else {
    alignment_.reset();
  }
  gnss_used_ = true;
  suspect_epochs_ = 0;
  last_reset_time_ = work.time;
  events_.emit(EventKind::kFilterReset, static_cast<std::uint8_t>(cause), moved_m, work.time);
}

// A given heading that has been used is good again only while nothing has moved since.
void GnssStage::watch_motion(const EpochWork& work) {
  for (const ImuSample& sample : work.block)
    given_heading_.watch(sample, config_.alignment.static_gyro_rad_s);
  if (!ekf_.initialized()) return;
  given_heading_.watch(ekf_.antenna_velocity_e().norm(), velocity_sigma(),
                       config_.alignment.min_course_speed_m_s);
}

double GnssStage::velocity_sigma() const {
  const Eigen::Matrix3d covariance =
      ekf_.covariance().block<3, 3>(ekf_index::kVelocity, ekf_index::kVelocity);
  return norm_of_sigmas(covariance) / std::sqrt(3.0);
}

void GnssStage::align(const EpochWork& work) {
  const bool fresh = !work.block.empty() && work.block.back().time == work.time;
  if (!inertial_ || ekf_.has_attitude() || !fresh) return;
  const auto given = given_heading_.get();
  const auto aligned = alignment_.attitude(ekf_.antenna_position_e(), ekf_.antenna_velocity_e(),
                                           velocity_sigma(), given);
  if (!aligned) return;
  given_heading_.use();
  ekf_.set_attitude(aligned->q_eb, aligned->sigma_rpy, aligned->gyro_bias_b,
                    aligned->gyro_bias_known);
  events_.emit(EventKind::kAligned, aligned->gyro_bias_known ? 1 : 0, aligned->sigma_rpy.z(),
               work.time);
}

void GnssStage::process_command(const Command& command) {
  if (command.kind == CommandKind::kSetHeading) return set_heading(command.value, command.sigma);
  ekf_ = Ekf(config_.ekf, config_.imu, config_.vehicle.lever_arm_b);
  alignment_.reset();
  suspect_epochs_ = 0;
  last_gnss_time_ = last_reset_time_ = GpsTime();
  events_.emit(EventKind::kFilterReset, static_cast<std::uint8_t>(command.cause), 0.0,
               last_epoch_time_);
}

// Before alignment: good for it. Afterwards: turns the filter's attitude about the vertical;
// position, velocity, clocks and IMU errors stay as they are.
void GnssStage::set_heading(double heading, double sigma) {
  if (!inertial_) return;
  given_heading_.tell({heading, sigma});
  if (!ekf_.has_attitude()) return;
  given_heading_.use();
  const NavState state = ekf_.state();
  start_report(0, state.time, true, report_.get());
  report_state(ekf_, report_.get());
  Eigen::Vector3d sigma_rpy = report_->solution.sigma_rpy;
  sigma_rpy.z() = sigma;
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(state.p_e));
  EulerAngles euler = euler_from_rotation(C_ne * state.q_eb.toRotationMatrix());
  euler.yaw = wrap_to_pi(heading);
  const Eigen::Matrix3d C_eb = C_ne.transpose() * rotation_from_euler(euler);
  ekf_.turn_attitude(Eigen::Quaterniond(C_eb).normalized(), sigma_rpy);
  events_.emit(EventKind::kAligned, 1, sigma, state.time);
}

// What is about to be delivered, checked once more as a whole: finite states could be so far out
// that their coordinates are not.
void GnssStage::report_solution(const EpochWork& work) {
  report_state(ekf_, report_.get());
  if (is_finite(report_->solution)) return;
  drop_filter(work.time);
  report_->solution = Solution();
  report_->solution.time = work.time;
}

void GnssStage::deliver(const EpochWork& work) {
  if (!inertial_) return;
  EkfUpdate update;
  update.index = work.index;
  update.valid = ekf_.initialized();
  if (update.valid) {
    update.has_attitude = ekf_.has_attitude();
    update.state = ekf_.state();
    update.covariance = ekf_.covariance().topLeftCorner<ekf_index::kInsSize, ekf_index::kInsSize>();
    update.gnss_used = gnss_used_;
  }
  mailbox_->deliver(work.index, update);
}

void GnssStage::publish(const EpochWork& work) {
  report_->solution.source = source();
  report_->solution.anchor_epoch = work.index;
  report_->sequence = next_report_++;
  if (!inertial_ && ekf_.initialized()) {
    report_->solution.sequence = next_solution_++;
    sink_->on_solution(report_->solution);
  }
  sink_->on_epoch(*report_);
}

void GnssStage::watch_orbits() {
  for (const SatelliteReport& satellite : report_->satellites) {
    if (!orbit_watch_.falls_back(satellite.satellite, satellite.source)) continue;
    // Events are thinned, so that a product that comes and goes does not drown the others.
    if (++orbit_fallbacks_ > 16 && orbit_fallbacks_ % 256 != 0) continue;
    events_.emit(EventKind::kOrbitFallback, static_cast<std::uint8_t>(satellite.satellite.system),
                 satellite.satellite.number, report_->time);
  }
}

Source GnssStage::source() const {
  if (!ekf_.initialized()) return Source::kNone;
  if (inertial_ && !ekf_.has_attitude()) return Source::kAligning;
  const double since_s = seconds_between(last_epoch_time_, last_gnss_time_);
  const bool recent = since_s <= 2.5 * config_.realtime.epoch_interval_s;
  return recent ? Source::kEkf : Source::kInsOnly;
}

}  // namespace leonav
