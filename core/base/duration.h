// This function converts a duration from seconds to an integer count of nanoseconds.
#pragma once
#include <cmath>
#include <cstdint>

namespace leonav {

// Rounds to the nearest nanosecond. For instants use GpsTime::plus_seconds(), which loses no digit
// of the fraction where the seconds are many.
inline std::int64_t rounded_nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

}  // namespace leonav
