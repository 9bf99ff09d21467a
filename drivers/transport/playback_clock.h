// The PlaybackClock tells when a recorded instant is due, so that several files keep one pace.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>

#include "drivers/transport/arrival_clock.h"

namespace leonav {

// Recorded time passes `speed` times as fast as the host's. The first instant that is asked for is
// due at once; every other one is due as much later as it was recorded, divided by the speed. An
// instant before the first one, or more than an hour after the latest, is due at once too: it is
// damage, or another recording, and must not hold the file up.
class PlaybackClock {
 public:
  using Steady = ArrivalClock::Steady;

  explicit PlaybackClock(double speed) : speed_(speed) {}

  Steady::time_point due(std::int64_t recorded_ns, Steady::time_point now);

 private:
  double speed_;
  bool has_begun_ = false;
  Steady::time_point begin_;
  std::int64_t first_ns_ = 0, latest_ns_ = 0;
};

}  // namespace leonav
