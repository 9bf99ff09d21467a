#include "drivers/rtcm3/msm_lock_time.h"

#include <algorithm>

namespace leonav {

std::int64_t least_lock_ms(std::uint32_t indicator) {
  return indicator == 0 ? 0 : std::int64_t{1} << (std::min(indicator, 15u) + 4);
}

// The indicator is the time itself up to 64 ms; then 32 values span each doubling.
std::int64_t least_lock_extended_ms(std::uint32_t indicator) {
  constexpr std::uint32_t kLargest = 704, kStep = 32;
  const std::uint32_t i = std::min(indicator, kLargest);
  if (i < 2 * kStep) return i;
  const std::uint32_t doublings = i / kStep - 1;
  return static_cast<std::int64_t>(i - kStep * doublings) << doublings;
}

bool lock_was_lost(const MsmLock& last, const MsmLock& now) {
  constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
  if (now.least_lock_ms == 0) return true;
  if (!last.time.is_set()) return false;
  if (now.least_lock_ms < last.least_lock_ms) return true;
  const std::int64_t elapsed_ns = nanoseconds_between(now.time, last.time);
  return elapsed_ns < 0 || now.least_lock_ms < elapsed_ns / kNanosecondsPerMillisecond;
}

}  // namespace leonav
