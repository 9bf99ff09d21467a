#include "core/ins/standstill_detector.h"

#include <algorithm>

namespace leonav {
namespace {

// An engine's shaking goes out by the mean.
constexpr double kPart_s = 0.1999;  // rounding must not make it a sample longer
constexpr double kSpeedSigmas = 3.5;

}  // namespace

void StandstillDetector::add(const ImuSample& sample) {
  if (last_.is_set() && sample.start() > last_.plus_seconds(sample.interval_s())) reset();
  last_ = sample.time;
  current_.seconds += sample.interval_s();
  current_.angle_b += sample.delta_theta_b;
  current_.velocity_b += sample.delta_velocity_b;
  if (current_.seconds < kPart_s) return;
  parts_[static_cast<std::size_t>(next_)] = current_;
  next_ = (next_ + 1) % kParts;
  known_ = std::min(known_ + 1, kParts);
  current_ = Part();
}

bool StandstillDetector::feels_still(const Eigen::Vector3d& rate_bias_b) const {
  if (known_ < kParts) return false;
  Eigen::Vector3d least = parts_[0].velocity_b / parts_[0].seconds, most = least;
  for (const Part& part : parts_) {
    const Eigen::Vector3d rate = part.angle_b / part.seconds - rate_bias_b;
    if (!(rate.cwiseAbs().maxCoeff() < config_.max_rate_rad_s)) return false;
    least = least.cwiseMin(part.velocity_b / part.seconds);
    most = most.cwiseMax(part.velocity_b / part.seconds);
  }
  return (most - least).maxCoeff() < config_.max_force_change_m_s2;
}

bool StandstillDetector::stands(const Eigen::Vector3d& rate_bias_b, double speed,
                                double sigma) const {
  return speed + kSpeedSigmas * sigma < config_.max_speed_m_s && feels_still(rate_bias_b);
}

Eigen::Vector3d StandstillDetector::rate_b() const {
  const Part& last = parts_[static_cast<std::size_t>((next_ + kParts - 1) % kParts)];
  return last.angle_b / std::max(1e-9, last.seconds);
}

}  // namespace leonav
