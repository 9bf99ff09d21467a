// A configured interval is converted from seconds to nanoseconds here.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace leonav {

// At least 50 ms, so that an interval configured as zero is still one.
inline std::int64_t interval_in_nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(std::max(seconds, 0.05) * 1e9));
}

}  // namespace leonav
