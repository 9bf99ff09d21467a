// This header finds full instants from times of week and truncated week numbers.
#pragma once
#include <cmath>
#include <cstdint>

#include "core/base/gps_time.h"

namespace leonav {

// Returns the full week whose remainder modulo `modulus` is `truncated`, nearest to
// `reference_week`.
constexpr int full_week(int truncated, int modulus, int reference_week) {
  int difference = (truncated - reference_week) % modulus;
  if (difference < 0) difference += modulus;
  if (difference > modulus / 2) difference -= modulus;
  return reference_week + difference;
}

// Returns the instant with this time of week, in nanoseconds and less than two weeks, that is
// nearest to `near`.
constexpr GpsTime nearest_instant_ns(std::int64_t tow_ns, GpsTime near) {
  const std::int64_t start = near.week() * kNanosecondsPerWeek;
  GpsTime time = GpsTime::from_nanoseconds(start + tow_ns);
  const std::int64_t ahead = time.nanoseconds() - near.nanoseconds();
  if (ahead > kNanosecondsPerWeek / 2) time = time.plus_nanoseconds(-kNanosecondsPerWeek);
  if (ahead < -kNanosecondsPerWeek / 2) time = time.plus_nanoseconds(kNanosecondsPerWeek);
  return time;
}

// Returns the same of a time of week in seconds.
constexpr GpsTime nearest_instant(std::int64_t tow_s, GpsTime near) {
  return nearest_instant_ns(tow_s * kNanosecondsPerSecond, near);
}

// Returns the same of a time of week that may be anything; unset if there is no such time.
inline GpsTime nearest_instant_of(double tow_s, GpsTime near) {
  if (!(tow_s >= 0.0 && tow_s < static_cast<double>(kSecondsPerWeek))) return {};
  return nearest_instant_ns(std::llround(tow_s * 1e9), near);
}

// Returns the instant at this offset from the start of a period that is nearest to `near`. Periods
// of equal length (a day, an hour) begin with GPS time.
constexpr GpsTime nearest_instant_of_period(std::int64_t offset_ns, std::int64_t period_ns,
                                            GpsTime near) {
  const std::int64_t ahead = (near.nanoseconds() - offset_ns) % period_ns;
  const std::int64_t after = ahead < 0 ? ahead + period_ns : ahead;
  return near.plus_nanoseconds(after > period_ns / 2 ? period_ns - after : -after);
}

// Returns whether a broadcast week number can be that of `time`: the week itself or, since receiver
// and satellite may be on two sides of a week's end, a neighbour. `offset` is week zero of the
// system's own count in GPS weeks.
constexpr bool week_agrees(int truncated, int modulus, int offset, GpsTime time) {
  const int difference = full_week(truncated + offset, modulus, time.week()) - time.week();
  return difference >= -1 && difference <= 1;
}

}  // namespace leonav
