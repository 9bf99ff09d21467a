#include "core/navigator/sequencer/internal/empty_epoch_schedule.h"

#include <algorithm>

#include "core/base/duration.h"
#include "core/navigator/sequencer/internal/interval.h"

namespace leonav {

EmptyEpochSchedule::EmptyEpochSchedule(const RealtimeConfig& config)
    : interval_ns_(interval_in_nanoseconds(config.epoch_interval_s)),
      wait_ns_(std::max(interval_ns_ / 2, rounded_nanoseconds(config.gnss_latency_allowance_s))) {}

GpsTime EmptyEpochSchedule::due_time(GpsTime imu_time, GpsTime last_epoch,
                                     GpsTime newest_start) const {
  const std::int64_t since_ns = nanoseconds_between(imu_time, last_epoch);
  const std::int64_t wait_ns = interval_ns_ + wait_ns_;
  if (since_ns < wait_ns) return {};
  const GpsTime nominal = last_epoch.plus_nanoseconds(interval_ns_);
  // The IMU gets this far ahead only by a gap. One empty epoch at its end replaces a burst of them.
  const GpsTime gap_end = newest_start;
  const bool gap = since_ns > 2 * wait_ns && gap_end > last_epoch;
  return gap ? gap_end : nominal;
}

// The wait becomes a quarter longer than this latency, because latencies vary.
void EmptyEpochSchedule::lengthen_wait(std::int64_t latency_ns) {
  wait_ns_ = std::max(wait_ns_, std::min(latency_ns + latency_ns / 4, kMaxGnssLatencyNs));
}

}  // namespace leonav
