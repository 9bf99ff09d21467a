#include "core/navigator/monitors/imu_gap_monitor.h"

#include <algorithm>

namespace leonav {

std::optional<double> ImuGapMonitor::add(const EpochWork& work) {
  double longest_s = 0.0;
  const auto end_gap_at = [&](GpsTime time) {
    if (last_sample_.is_set()) longest_s = std::max(longest_s, seconds_between(time, last_sample_));
  };
  for (const ImuSample& sample : work.block) {
    end_gap_at(sample.start());
    last_sample_ = sample.time;
  }
  end_gap_at(work.time);
  if (longest_s <= kLongestGap_s) return std::nullopt;
  return longest_s;
}

}  // namespace leonav
