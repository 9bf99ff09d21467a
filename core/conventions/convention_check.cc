#include "core/conventions/convention_check.h"

#include "core/conventions/force_check.h"

namespace leonav {

void ConventionCheck::clear() {
  record_.clear();
  told_ = false;
}

void ConventionCheck::add(const ImuSample& sample) {
  if (!told_) record_.add(sample);
}

bool ConventionCheck::is_due(GpsTime time) const { return !told_ && record_.is_due(time); }

ConventionFinding ConventionCheck::end_second(GpsTime time, const PointSolution* point) {
  if (record_.end_second(time, point) == nullptr) return {};
  const ConventionFinding finding = judge();
  told_ = static_cast<bool>(finding);
  return finding;
}

ConventionFinding ConventionCheck::judge() const {
  const MeanForce force = mean_force(record_);
  if (const auto finding = check_force_size(force, record_.imu_interval_s())) return finding;
  return {};
}

}  // namespace leonav
