// This header converts BeiDou seconds of week to GPS time.
#pragma once
#include "core/base/calendar.h"
#include "drivers/binary/week_time.h"

namespace leonav {

inline constexpr int kBeidouWeekModulus = 8192;

// Returns the instant with this BeiDou second of week that is nearest to `near`.
inline GpsTime nearest_beidou_instant(std::int64_t sow_s, GpsTime near) {
  const GpsTime near_bdt = near.plus_nanoseconds(kBeidouMinusGpsSeconds * kNanosecondsPerSecond);
  return nearest_instant(sow_s, near_bdt)
      .plus_nanoseconds(-kBeidouMinusGpsSeconds * kNanosecondsPerSecond);
}

// Returns whether a broadcast BeiDou week number can be that of `time` (see week_agrees).
inline bool beidou_week_agrees(int week, GpsTime time) {
  return week_agrees(week, kBeidouWeekModulus, kBeidouWeekZeroInGpsWeeks, time);
}

}  // namespace leonav
