// EmptyEpochSchedule decides when an empty epoch is issued for a GNSS epoch that has not come.
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

  // Returns the time of the empty epoch that is due; unset: none is. It lies one interval after the
  // last epoch or, where the IMU stream has a gap there, at the gap's end. `newest_start` is the
  // start of the newest IMU sample.
  GpsTime due_time(GpsTime imu_time, GpsTime last_epoch, GpsTime newest_start) const;

  // Lengthens the wait for an epoch that came with this latency after an empty one had been issued
  // for it.
  void lengthen_wait(std::int64_t latency_ns);
  // Returns how long after its time an epoch is waited for.
  std::int64_t wait_ns() const { return wait_ns_; }

 private:
  std::int64_t interval_ns_, wait_ns_;
};

}  // namespace leonav
