// The EmptyEpochSchedule decides when an epoch without GNSS is issued for one that has not come.
#pragma once
#include <cstdint>

#include "core/navigator/interface/navigator_config.h"

namespace leonav {

// An empty epoch is due once the IMU has run one epoch interval and the wait past the last epoch.
// The wait is the configured latency allowance, at least half an interval, and grows with the
// latencies seen.
class EmptyEpochSchedule {
 public:
  static constexpr std::int64_t kMaxGnssLatencyNs = 2'000'000'000;

  explicit EmptyEpochSchedule(const RealtimeConfig& config);

  // Time of the empty epoch that is due; unset: none. One interval after the last epoch, or where
  // the IMU stream has a hole there, at the hole's end. `newest_start`: of the newest IMU sample.
  GpsTime due_time(GpsTime imu_time, GpsTime last_epoch, GpsTime newest_start) const;

  // An epoch came so long after its time, and an empty one had been issued for it.
  void lengthen_wait(std::int64_t latency_ns);
  std::int64_t wait_ns() const { return wait_ns_; }  // for an epoch after its time

 private:
  std::int64_t interval_ns_, wait_ns_;
};

}  // namespace leonav
