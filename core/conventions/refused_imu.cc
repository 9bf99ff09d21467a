#include "core/conventions/refused_imu.h"

#include <cmath>

namespace leonav {
namespace {

constexpr double kGravity = 9.80665;  // m/s^2
constexpr int kMinRun = 100;
constexpr double kLowest = 0.5, kHighest = 2.0;  // of what is expected: it may be moving

bool is_about(double value, double expected) {
  return value > kLowest * expected && value < kHighest * expected;
}

}  // namespace

ConventionFinding RefusedImuWatch::add_refused(const ImuSample& sample) {
  if (told_ || !sample.delta_velocity_b.allFinite() || !sample.delta_theta_b.allFinite()) return {};
  if (run_ == 0) seconds_ = speed_ = angle_ = 0.0;
  ++run_;
  interval_s_ = sample.interval_s();
  seconds_ += interval_s_;
  speed_ += sample.delta_velocity_b.norm();
  angle_ += sample.delta_theta_b.norm();
  if (run_ < kMinRun || !(seconds_ > 0.0)) return {};
  const ConventionFinding finding = judge();
  told_ = static_cast<bool>(finding);
  return finding;
}

ConventionFinding RefusedImuWatch::judge() const {
  const double ratio = speed_ / seconds_ / kGravity;
  if (!std::isfinite(ratio) || !std::isfinite(angle_)) return {};
  if (is_about(ratio * interval_s_, 1.0)) return {Convention::kRatesAsIncrements, ratio};
  if (is_about(ratio, 1.0)) return {Convention::kGyroRange, angle_ / seconds_};
  return {Convention::kForceUnit, ratio};
}

}  // namespace leonav
