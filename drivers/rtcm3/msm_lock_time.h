// This unit reads the lock time indicators of the multiple signal messages and decides whether a
// carrier is continuous.
#pragma once
#include <cstdint>

#include "core/base/gps_time.h"

namespace leonav {

// Each function returns the least time in milliseconds for which the carrier has been tracked
// without interruption, of an indicator with 4 bits (DF402) or 10 bits (DF407; reserved values
// count as the largest). Source: RTCM 10403.3, tables 3.5-74 and 3.5-75.
std::int64_t least_lock_ms(std::uint32_t indicator);
std::int64_t least_lock_extended_ms(std::uint32_t indicator);

// The last epoch at which a signal's carrier was measured.
struct MsmLock {
  GpsTime time;  // unset: never
  std::int64_t least_lock_ms = 0;
};

// Returns whether the carrier's cycle count may have been interrupted since `last`.
//
// An interruption leaves a lock younger than the last epoch. As the indicator states only a lower
// bound, a carrier that cannot be shown to be older counts as interrupted; that costs at most the
// second epoch of an arc. A signal's first carrier interrupts nothing unless its lock time is zero.
bool lock_was_lost(const MsmLock& last, const MsmLock& now);

}  // namespace leonav
