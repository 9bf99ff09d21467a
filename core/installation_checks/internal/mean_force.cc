#include "core/installation_checks/internal/mean_force.h"

#include <algorithm>
#include <cmath>

#include "core/base/capacity.h"
#include "core/base/median.h"
#include "core/installation_checks/internal/is_near.h"

namespace leonav {
namespace {

constexpr int kMinForceSeconds = 10;
constexpr double kLeastForce = 0.7,
                 kMostForce = 1.4;  // times gravity: a bad sensor, a rough flight
constexpr double kNoGravity = 0.3;

}  // namespace

double MeanForce::tilt() const { return std::atan2(mean_b.head<2>().norm(), -mean_b.z()); }

bool MeanForce::known() const { return seconds >= kMinForceSeconds; }

MeanForce mean_force(const MotionRecord& record, MotionSeconds which) {
  MeanForce force;
  boost::container::static_vector<double, MotionRecord::kCapacity> sizes;
  for (const MotionSecond& second : record.seconds()) {
    if (!second.has_imu || (which == MotionSeconds::kWithCourse && !second.has_course)) continue;
    sizes.push_back(second.force_b.norm());
    force.mean_b += second.force_b;
  }
  force.seconds = static_cast<int>(sizes.size());
  if (sizes.empty()) return force;
  force.ratio = median(sizes) / kStandardGravity;
  force.mean_b /= static_cast<double>(sizes.size()) * kStandardGravity;
  return force;
}

ConventionFinding check_force_size(const MeanForce& force, double imu_interval_s) {
  const double ratio = force.ratio;
  if (!force.known() || (ratio > kLeastForce && ratio < kMostForce)) return {};
  if (is_near(ratio, 1.0 / kStandardGravity, 0.1)) return {Convention::kForceInG, ratio};
  if (is_near(ratio, imu_interval_s, 0.2) && ratio < 0.09)
    return {Convention::kIncrementsTimesInterval, ratio};
  if (ratio < kNoGravity) return {Convention::kGravityMissing, ratio};
  return {Convention::kForceUnit, ratio};
}

}  // namespace leonav
