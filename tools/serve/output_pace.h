// The OutputPace decides which solutions become sentences.
#pragma once
#include <cmath>
#include <cstdint>

#include "core/base/gps_time.h"

namespace leonav {

// The first solution at or after each multiple of the interval is due, by the solution's own time,
// so that a log played fast gives the same sentences. A stamp up to a microsecond early counts as
// on time. Older solutions are not due, but for a step back of more than ten seconds: a new run.
class OutputPace {
 public:
  explicit OutputPace(double rate_hz)
      : interval_ns_(std::llround(static_cast<double>(kNanosecondsPerSecond) / rate_hz)) {}

  bool is_due(GpsTime time) {
    constexpr std::int64_t kEarly_ns = 1'000, kNewRun_ns = 10 * kNanosecondsPerSecond;
    const std::int64_t slot = (time.nanoseconds() + kEarly_ns) / interval_ns_;
    const bool is_new_run = nanoseconds_between(last_, time) > kNewRun_ns;
    if (slot <= slot_ && !is_new_run) return false;
    slot_ = slot;
    last_ = time;
    return true;
  }

 private:
  std::int64_t interval_ns_, slot_ = -1;
  GpsTime last_;
};

}  // namespace leonav
