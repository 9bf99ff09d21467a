#include "core/navigator/monitors/imu_gap_monitor.h"

#include <algorithm>

namespace leonav {

std::optional<double> ImuGapMonitor::add(const EpochWork& work) {
  double gap_s = 0.0;
  const auto extend_to = [&](GpsTime time) {
    const double since_s = last_sample_.is_set() ? seconds_between(time, last_sample_) : 0.0;
    if (since_s > kLongestGap_s && !is_told_) {
      gap_s = std::max(gap_s, since_s);
      is_told_ = true;
    }
  };
  for (const ImuSample& sample : work.block) {
    extend_to(sample.start());
    last_sample_ = sample.time;
    is_told_ = false;
  }
  extend_to(work.time);
  if (gap_s == 0.0) return std::nullopt;
  return gap_s;
}

}  // namespace leonav
