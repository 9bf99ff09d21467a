#include "core/navigator/monitors/filter_monitor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/filter/state/covariance_blocks.h"
#include "core/navigator/interface/filter_estimate.h"
#include "core/navigator/interface/solution_conversion.h"

namespace leonav {
namespace {

constexpr int kMinMeasurementsToTest = 4;  // codes or Dopplers
// A filter with a larger sigma adds nothing to a point solution.
constexpr double kMaxUsefulSigma_m = 500.0;
constexpr double kMaxUsefulSigmaWithArcs_m = 1e5;
// If a second reset follows within this time, the attitude is wrong as well.
constexpr double kRepeatedReset_s = 60.0;
// A restart by test_rejections() inflates the filter's sigmas by at most these.
constexpr double kMaxInflation_m = 250.0, kMaxInflation_m_s = 30.0;
// If nearly all measurements are rejected again within this time, the restart has not helped.
constexpr double kRepeatedRejection_s = 90.0;
// A difference of more 3D sigmas of the point solution contradicts the filter.
constexpr double kContradictingSigmas = 3.0;
// Limits of test_position(): all codes agree on another position than the filter's.
constexpr int kMinCodesToMove = 7;
constexpr int kMinMoveRedundancy = 3;
// Mean consistency ratio up to which codes agree with the filter.
constexpr double kMaxAgreeingRatio = 1.5;
constexpr double kDisplacedPointSigmas = 2.0;  // sigmas of one point solution, in the mean of many
constexpr double kDisplacedFilterSigmas = 5.0;
constexpr double kDisplacementTimeConstant_s = 15.0;
// Evidence is redundant codes times seconds.
constexpr double kDisplacementEvidenceToMove_s = 120.0;  // 30 s of eight codes of one system
constexpr double kMaxTrust_s = 480.0;                    // a longer agreement adds no evidence
constexpr double kLongestInterval_s = 10.0;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Eigen::Matrix3d inflated(const Eigen::Matrix3d& covariance, double sigma) {
  return covariance + sigma * sigma * Eigen::Matrix3d::Identity();
}

// Returns the filter's own estimate as a point solution, inflated by these sigmas.
PointSolution inflated_estimate(const Ekf& filter, double sigma_m, double sigma_m_s) {
  PointSolution own;
  own.p_e = filter.antenna_position_e();
  own.v_e = filter.antenna_velocity_e();
  own.has_velocity = true;
  own.covariance_p_e = inflated(position_covariance_e(filter.covariance()), sigma_m);
  own.covariance_v_e = inflated(velocity_covariance_e(filter.covariance()), sigma_m_s);
  const ClockFlags& known = filter.estimate().known_clocks();
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system) {
    const auto i = static_cast<Eigen::Index>(system);
    own.clock_m[system] =
        known.offset[system] ? filter.filter_state().clocks.offset_m(i) : kUnknown;
    own.clock_drift_m_s[system] =
        known.drift[system] ? filter.filter_state().clocks.drift_m_s(i) : kUnknown;
  }
  return own;
}

FilterVerdict drop(ResetCause cause, double value) {
  FilterVerdict verdict;
  verdict.action = FilterAction::kDrop;
  verdict.cause = cause;
  verdict.value = value;
  return verdict;
}

}  // namespace

FilterMonitor::FilterMonitor(const NavigatorConfig& config)
    : reset_ratio_(config.ekf.reset_ratio),
      max_arc_gap_s_(config.ekf.max_arc_gap_s),
      reset_epochs_(config.ekf.reset_epochs),
      use_carrier_(config.ekf.use_carrier) {}

FilterVerdict FilterMonitor::test_finite(const Ekf& filter) const {
  if (filter.initialized() && !filter.estimate().is_finite())
    return drop(ResetCause::kNotFinite, 0.0);
  return {};
}

bool FilterMonitor::prediction_is_too_uncertain(const Ekf& filter, GpsTime time,
                                                GpsTime last_gnss) const {
  const bool arcs =
      use_carrier_ && last_gnss.is_set() && seconds_between(time, last_gnss) <= max_arc_gap_s_;
  const double limit_m = arcs ? kMaxUsefulSigmaWithArcs_m : kMaxUsefulSigma_m;
  return !filter.state().p_e.allFinite() || !(position_sigma(filter) < limit_m);
}

FilterVerdict FilterMonitor::restart_after_outage(const PointSolution& point, const Ekf& filter,
                                                  GpsTime time) const {
  return restart_from(point, ResetCause::kOutage, filter, time);
}

// The attitude is kept with the IMU errors, unless it was already kept in a reset shortly before.
// Then it was wrong, and the vehicle constants that were estimated with it are dropped too.
FilterVerdict FilterMonitor::restart_from(const PointSolution& point, ResetCause cause,
                                          const Ekf& filter, GpsTime time) const {
  FilterVerdict verdict;
  verdict.action = FilterAction::kRestart;
  verdict.cause = cause;
  verdict.value = cause == ResetCause::kLockedOut
                      ? norm_of_sigmas(point.covariance_p_e)
                      : (point.p_e - filter.antenna_position_e()).norm();
  verdict.start = point;
  const bool repeated =
      last_reset_time_.is_set() && seconds_between(time, last_reset_time_) < kRepeatedReset_s;
  verdict.keeps_attitude =
      filter.has_attitude() && !repeated && filter.state().q_eb.coeffs().allFinite();
  verdict.keeps_vehicle_constants = !repeated;
  return verdict;
}

FilterVerdict FilterMonitor::test_prediction(const FilterEvidence& evidence,
                                             IndependentSolver* solver) {
  const EkfUpdateResult& update = evidence.update;
  const auto most = [&](int rejected, int offered) {
    return offered >= kMinMeasurementsToTest && rejected >= reset_ratio_ * offered;
  };
  const auto most_of = [&](Observable observable) {
    const auto kind = static_cast<std::size_t>(observable);
    return most(update.rejected[kind], update.offered[kind]);
  };
  const bool code = most_of(Observable::kCode);
  const bool doppler = most_of(Observable::kDoppler);
  const bool contradicted = code || doppler;
  contradicted_epochs_ = contradicted ? contradicted_epochs_ + 1 : 0;
  if (contradicted_epochs_ != 1 && contradicted_epochs_ < reset_epochs_) return {};
  const IndependentSolution solution = solver->solve(evidence.filter.antenna_position_e());
  const bool checked = solution.accepted && redundancy(solution.point) >= kMinResetRedundancy &&
                       most_codes_agree(*solution.measurements);
  if (contradicted_epochs_ == 1) {
    first_contradiction_time_ = checked ? evidence.time : GpsTime();
    first_contradiction_point_ = solution.point;
  }
  if (checked && contradicted_epochs_ >= reset_epochs_ &&
      contradicts(solution.point, evidence.filter, evidence.time, doppler))
    return restart_from(solution.point, ResetCause::kPrediction, evidence.filter, evidence.time);
  return {};
}

FilterVerdict FilterMonitor::test_position(const FilterEvidence& evidence,
                                           IndependentSolver* solver) {
  const EkfUpdateResult& update = evidence.update;
  const auto code = static_cast<std::size_t>(Observable::kCode);
  const double passed_s =
      seconds_between(evidence.time, std::exchange(last_position_test_time_, evidence.time));
  const double interval_s = std::clamp(passed_s, 0.0, kLongestInterval_s);
  if (update.offered[code] < kMinCodesToMove) return {};
  if (update.rejected[code] == 0 && consistency_[0].mean() < kMaxAgreeingRatio) {
    const int redundant = update.offered[code] - 3 - static_cast<int>(kMaxSystemTimes);
    displacement_evidence_ =
        std::max(-kMaxTrust_s, displacement_evidence_ - std::max(redundant, 1) * interval_s);
    return {};
  }
  const IndependentSolution solution = solver->solve(evidence.filter.antenna_position_e());
  const PointSolution& point = solution.point;
  const bool clear = solution.accepted && redundancy(point) >= kMinMoveRedundancy &&
                     all_codes_agree(*solution.measurements);
  if (!clear) return {};
  const double weight = redundancy(point) * interval_s;
  const Eigen::Vector3d off_e = point.p_e - evidence.filter.antenna_position_e();
  mean_displacement_e_ +=
      std::min(1.0, interval_s / kDisplacementTimeConstant_s) * (off_e - mean_displacement_e_);
  const double limit_m = std::max(kDisplacedPointSigmas * norm_of_sigmas(point.covariance_p_e),
                                  kDisplacedFilterSigmas * position_sigma(evidence.filter));
  const bool away = mean_displacement_e_.norm() > limit_m;
  displacement_evidence_ =
      std::max(-kMaxTrust_s, displacement_evidence_ + (away ? weight : -weight));
  if (away && displacement_evidence_ > kDisplacementEvidenceToMove_s)
    return restart_from(point, ResetCause::kPrediction, evidence.filter, evidence.time);
  return {};
}

// Nothing decides whether the filter or the rejected measurements are wrong. The filter therefore
// continues from its own position, with a sigma as large as the discrepancy.
FilterVerdict FilterMonitor::test_rejections(const FilterEvidence& evidence) {
  const RejectionVerdict found =
      rejection_monitor_.add(evidence.update, evidence.measurements, evidence.time);
  if (found == RejectionVerdict::kClocks) {
    FilterVerdict verdict;
    verdict.action = FilterAction::kRestartClocks;
    return verdict;
  }
  if (found != RejectionVerdict::kPosition) return {};
  const bool again = last_rejection_restart_.is_set() &&
                     seconds_between(evidence.time, last_rejection_restart_) < kRepeatedRejection_s;
  const bool far = rejection_monitor_.code_discrepancy_m() > kMaxInflation_m &&
                   rejection_monitor_.enough_to_start();
  if (again || far) return drop(ResetCause::kLockedOut, rejection_monitor_.code_discrepancy_m());
  last_rejection_restart_ = evidence.time;
  const PointSolution own = inflated_estimate(
      evidence.filter, std::min(rejection_monitor_.code_discrepancy_m(), kMaxInflation_m),
      std::min(rejection_monitor_.doppler_discrepancy_m_s(), kMaxInflation_m_s));
  return restart_from(own, ResetCause::kLockedOut, evidence.filter, evidence.time);
}

// Dopplers alone could all be wrong, for instance with the wrong sign or unit. Therefore position
// and clocks from the codes must have changed as the Dopplers predict, rather than as the filter
// predicts.
bool FilterMonitor::motion_supports_point(const PointSolution& point, const Ekf& filter,
                                          GpsTime time) const {
  if (!first_contradiction_time_.is_set() || !(first_contradiction_time_ < time)) return false;
  const double dt = seconds_between(time, first_contradiction_time_);
  const Eigen::Vector3d moved_m_s = (point.p_e - first_contradiction_point_.p_e) / dt;
  double from_point = (moved_m_s - point.v_e).squaredNorm();
  double from_filter = (moved_m_s - filter.antenna_velocity_e()).squaredNorm();
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system) {
    const double ran_m_s =
        (point.clock_m[system] - first_contradiction_point_.clock_m[system]) / dt;
    const double drift_m_s =
        filter.filter_state().clocks.drift_m_s(static_cast<Eigen::Index>(system));
    if (!filter.estimate().known_clocks().drift[system] ||
        !std::isfinite(ran_m_s + point.clock_drift_m_s[system]))
      continue;
    from_point += std::pow(ran_m_s - point.clock_drift_m_s[system], 2);
    from_filter += std::pow(ran_m_s - drift_m_s, 2);
  }
  return from_point < from_filter;
}

// Returns whether the filter's position differs from that of a point solution; with `motion` also
// whether velocity or clock drift differ.
bool FilterMonitor::contradicts(const PointSolution& point, const Ekf& filter, GpsTime time,
                                bool motion) const {
  const double distance_m = (point.p_e - filter.antenna_position_e()).norm();
  if (distance_m > kContradictingSigmas * norm_of_sigmas(point.covariance_p_e)) return true;
  if (!motion || !point.has_velocity) return false;
  const double limit_m_s = kContradictingSigmas * norm_of_sigmas(point.covariance_v_e);
  bool differs = (point.v_e - filter.antenna_velocity_e()).norm() > limit_m_s;
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system) {
    if (!filter.estimate().known_clocks().drift[system] ||
        !std::isfinite(point.clock_drift_m_s[system]))
      continue;
    const double drift_m_s =
        filter.filter_state().clocks.drift_m_s(static_cast<Eigen::Index>(system));
    differs = differs || std::abs(point.clock_drift_m_s[system] - drift_m_s) > limit_m_s;
  }
  return differs && motion_supports_point(point, filter, time);
}

std::array<std::optional<double>, 2> FilterMonitor::add_consistency(const EkfUpdateResult& update) {
  const std::array<double, 2> ratios = {update.code_ratio, update.doppler_ratio};
  std::array<std::optional<double>, 2> improbable;
  for (std::size_t i = 0; i < ratios.size(); ++i)
    if (consistency_[i].add(ratios[i])) improbable[i] = consistency_[i].mean();
  return improbable;
}

void FilterMonitor::filter_restarted(GpsTime time) {
  clear_evidence();
  last_reset_time_ = time;
}

void FilterMonitor::time_begins_anew() {
  clear_evidence();
  last_reset_time_ = last_rejection_restart_ = GpsTime();
}

void FilterMonitor::clear_evidence() {
  contradicted_epochs_ = 0;
  rejection_monitor_.reset();
  displacement_evidence_ = 0.0;
  mean_displacement_e_.setZero();
}

}  // namespace leonav
