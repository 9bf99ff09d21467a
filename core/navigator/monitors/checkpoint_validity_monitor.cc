#include "core/navigator/monitors/checkpoint_validity_monitor.h"

#include <algorithm>
#include <cmath>

#include "core/base/angle.h"
#include "core/earth/rotation.h"
#include "core/inertial/strapdown/imu_gap_fill.h"

namespace leonav {
namespace {

constexpr double kWindow_s = 1.0;       // noise and vibration average out over this time
constexpr double kGoodPosition_m = 10;  // 1 sigma; a larger one proves nothing
// Tolerance beyond the sigmas, for the error of reflected codes.
constexpr double kSamePlace_m = 10.0;
constexpr double kPlaceSigmas = 3.0;
constexpr double kTurned = 5.0 * kDegree;  // in all, beyond the gyros' bias
// Least sigma of a parked vehicle's heading. It may be moved a little on a slope, by a jack, or by
// people getting in, and the sigma of the earlier run may be too small.
constexpr double kLeastSigma = 2.0 * kDegree;
// The clock of a receiver that has just started is slightly wrong.
constexpr double kFutureTolerated_s = 1.0;

}  // namespace

std::string_view to_string(CheckpointUse use) {
  switch (use) {
    case CheckpointUse::kUsed:
      return "used";
    case CheckpointUse::kElsewhere:
      return "elsewhere";
    case CheckpointUse::kOld:
      return "old";
    case CheckpointUse::kFuture:
      return "future";
    case CheckpointUse::kTakenMoving:
      return "taken_moving";
    case CheckpointUse::kMoves:
      return "moves";
    case CheckpointUse::kNotNeeded:
      return "not_needed";
    case CheckpointUse::kCalibrationUsed:
      return "calibration_used";
    case CheckpointUse::kCalibrationOld:
      return "calibration_old";
    case CheckpointUse::kCalibrationMounted:
      return "calibration_mounted";
    case CheckpointUse::kCalibrationImu:
      return "calibration_imu";
  }
  return "unknown";
}

void CheckpointValidityMonitor::take(const Checkpoint& checkpoint) { checkpoint_ = checkpoint; }

void CheckpointValidityMonitor::add(const ImuSample& sample) {
  // The vehicle may have turned unnoticed in a gap that is too long to be filled.
  if (last_.is_set() && seconds_between(sample.start(), last_) > kMaxImuGap_s) turned_ = true;
  last_ = sample.time;
  window_s_ += sample.interval_s();
  all_s_ += sample.interval_s();
  all_turn_ = (all_turn_ * quaternion_from_rotation_vector(sample.delta_theta_b)).normalized();
  window_turn_ += sample.delta_theta_b;
  if (window_s_ < kWindow_s) return;
  turned_ = turned_ || !(window_turn_.norm() < config_.static_gyro_rad_s * window_s_);
  // A slow turn shows in the sum over all samples, beyond the effect of the gyros' bias at rest.
  const double drifted = kPlaceSigmas * rate_sigma_ * all_s_;
  turned_ = turned_ || 2.0 * std::acos(std::min(1.0, std::abs(all_turn_.w()))) > kTurned + drifted;
  window_s_ = 0.0;
  window_turn_.setZero();
}

std::optional<CheckpointValidityMonitor::Verdict> CheckpointValidityMonitor::evaluate(
    const Filter& filter) {
  if (!checkpoint_) return std::nullopt;
  const auto result = verdict(filter);
  if (result) checkpoint_.reset();
  return result;
}

std::optional<CheckpointValidityMonitor::Verdict> CheckpointValidityMonitor::verdict(
    const Filter& filter) const {
  const double age_s = seconds_between(filter.time, checkpoint_->time);
  if (age_s > max_age_s_) return Verdict{CheckpointUse::kOld, age_s, {}};
  if (age_s < -kFutureTolerated_s) return Verdict{CheckpointUse::kFuture, -age_s, {}};
  if (!checkpoint_->standing) return Verdict{CheckpointUse::kTakenMoving, 0.0, {}};
  // The sigma is doubled: one velocity of many may contradict standing by chance.
  const bool moves =
      !may_be_stationary(filter.speed, 2.0 * filter.sigma_v, config_.min_course_speed_m_s);
  if (turned_ || moves) return Verdict{CheckpointUse::kMoves, filter.speed, {}};
  const bool stands =
      may_be_stationary(filter.speed, filter.sigma_v, config_.min_course_speed_m_s) &&
      filter.sigma_v < config_.min_course_speed_m_s;
  if (!stands || !(filter.sigma_p < kGoodPosition_m)) return std::nullopt;

  const double distance_m = (filter.p_e - checkpoint_->antenna_p_e).norm();
  const double limit_m =
      kSamePlace_m + kPlaceSigmas * std::hypot(filter.sigma_p, checkpoint_->antenna_sigma);
  if (!(distance_m <= limit_m)) return Verdict{CheckpointUse::kElsewhere, distance_m, {}};
  const double sigma = std::max(checkpoint_->heading_sigma, kLeastSigma);
  return Verdict{CheckpointUse::kUsed, distance_m, {checkpoint_->heading, sigma}};
}

CheckpointValidityMonitor::Verdict CheckpointValidityMonitor::not_needed() {
  checkpoint_.reset();
  return {CheckpointUse::kNotNeeded, 0.0, {}};
}

}  // namespace leonav
