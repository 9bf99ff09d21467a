#include "drivers/transport/playback_clock.h"

#include <algorithm>

namespace leonav {

PlaybackClock::Steady::time_point PlaybackClock::due(std::int64_t recorded_ns,
                                                     Steady::time_point now) {
  constexpr std::int64_t kLongestHole_ns = 3'600'000'000'000;
  const bool is_far =
      has_begun_ && recorded_ns > latest_ns_ && recorded_ns - latest_ns_ > kLongestHole_ns;
  if (!has_begun_ || is_far) {
    has_begun_ = true;
    begin_ = now;
    first_ns_ = latest_ns_ = recorded_ns;
    return now;
  }
  if (recorded_ns <= first_ns_) return now;
  latest_ns_ = std::max(latest_ns_, recorded_ns);
  const double elapsed_ns = static_cast<double>(recorded_ns - first_ns_) / speed_;
  return begin_ + std::chrono::nanoseconds(static_cast<std::int64_t>(elapsed_ns));
}

}  // namespace leonav
