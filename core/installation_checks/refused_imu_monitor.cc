#include "core/installation_checks/refused_imu_monitor.h"

#include "core/installation_checks/internal/mean_force.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

constexpr int kMinRun = 100, kLongestRun = 2 * kMinRun;
// times the expected value: the vehicle may be moving
constexpr double kLeastShare = 0.5, kMostShare = 2.0;

bool is_about(double value, double expected) {
  return value > kLeastShare * expected && value < kMostShare * expected;
}

}  // namespace

ConventionFinding RefusedImuMonitor::add_refused(const ImuSample& sample) {
  if (!sample.delta_velocity_b.allFinite() || !sample.delta_theta_b.allFinite()) return {};
  if (run_ == 0) seconds_ = speed_ = angle_ = due_s_ = 0.0;
  // So that it is over soon after the last one, however long it was.
  run_ = std::min(run_ + 1, kLongestRun);
  interval_s_ = sample.interval_s();
  seconds_ += interval_s_;
  speed_ += sample.delta_velocity_b.norm();
  angle_ += sample.delta_theta_b.norm();
  if (run_ < kMinRun || !(seconds_ > due_s_)) return {};
  const ConventionFinding finding = evaluate();
  if (finding) due_s_ = seconds_ + kFoundAgain_s;
  return finding;
}

ConventionFinding RefusedImuMonitor::evaluate() const {
  const double ratio = speed_ / seconds_ / kStandardGravity;
  if (!std::isfinite(ratio) || !std::isfinite(angle_)) return {};
  if (is_about(ratio * interval_s_, 1.0)) return {Convention::kRatesAsIncrements, ratio};
  if (is_about(ratio, 1.0)) return {Convention::kGyroRange, angle_ / seconds_};
  return {Convention::kForceUnit, ratio};
}

}  // namespace leonav
