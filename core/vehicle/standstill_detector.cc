#include "core/vehicle/standstill_detector.h"

#include <algorithm>

namespace leonav {
namespace {

// The mean over a part averages out an engine's vibration.
constexpr double kPart_s = 0.1999;  // below 0.2 s: rounding must not add a sample
constexpr double kSpeedSigmas = 3.5;
constexpr double kMovingSigmas = 3.0;
constexpr int kRemembered = 15;  // fifths of a second

}  // namespace

void StandstillDetector::add(const ImuSample& sample) {
  if (last_.is_set() && sample.start() > last_.plus_seconds(sample.interval_s())) reset();
  last_ = sample.time;
  current_.seconds += sample.interval_s();
  current_.angle_b += sample.delta_theta_b;
  current_.velocity_b += sample.delta_velocity_b;
  if (current_.seconds < kPart_s) return;
  const Part leaving = parts_[static_cast<std::size_t>(next_)];
  const bool left = known_ == kParts;
  parts_[static_cast<std::size_t>(next_)] = current_;
  next_ = (next_ + 1) % kParts;
  known_ = std::min(known_ + 1, kParts);
  current_ = Part();
  if (left) update_force_mean(leaving.force_b());
}

// Updates the mean force before the last second, or starts anew if something has moved.
void StandstillDetector::update_force_mean(const Eigen::Vector3d& force_b) {
  if (spread().maxCoeff() >= config_.max_force_change_m_s2 ||
      (before_ >= kParts && !mean_force_is_unchanged())) {
    before_ = 0;
    return;
  }
  before_ = std::min(before_ + 1, kRemembered);
  before_b_ += (force_b - before_b_) / before_;
}

Eigen::Vector3d StandstillDetector::spread() const {
  Eigen::Vector3d least = parts_[0].force_b(), most = least;
  for (const Part& part : parts_) {
    least = least.cwiseMin(part.force_b());
    most = most.cwiseMax(part.force_b());
  }
  return most - least;
}

bool StandstillDetector::mean_force_is_unchanged() const {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Part& part : parts_) mean += part.force_b() / kParts;
  return (mean - before_b_).cwiseAbs().maxCoeff() < config_.max_force_drift_m_s2;
}

bool StandstillDetector::imu_is_static(const Eigen::Vector3d& rate_bias_b) const {
  if (known_ < kParts || before_ < kParts) return false;
  for (const Part& part : parts_) {
    const Eigen::Vector3d rate = part.angle_b / part.seconds - rate_bias_b;
    if (!(rate.cwiseAbs().maxCoeff() < config_.max_rate_rad_s)) return false;
  }
  return spread().maxCoeff() < config_.max_force_change_m_s2 && mean_force_is_unchanged();
}

bool StandstillDetector::stands(const Eigen::Vector3d& rate_bias_b, double speed,
                                double sigma) const {
  sigma = std::max(sigma, config_.least_sigma_m_s);
  return speed + kSpeedSigmas * sigma < config_.max_speed_m_s && speed < kMovingSigmas * sigma &&
         imu_is_static(rate_bias_b);
}

Eigen::Vector3d StandstillDetector::rate_b() const {
  const Part& last = parts_[static_cast<std::size_t>((next_ + kParts - 1) % kParts)];
  return last.angle_b / std::max(1e-9, last.seconds);
}

}  // namespace leonav
