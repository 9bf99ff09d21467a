// This function converts a configured interval from seconds to nanoseconds.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace leonav {

// Returns at least 50 ms, because an interval must not be zero.
inline std::int64_t interval_in_nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(std::max(seconds, 0.05) * 1e9));
}

}  // namespace leonav
