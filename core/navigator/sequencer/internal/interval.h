// This function converts a configured interval from seconds to nanoseconds.
#pragma once
#include <algorithm>
#include <cstdint>

#include "core/base/duration.h"

namespace leonav {

// Returns at least 50 ms, because an interval must not be zero.
inline std::int64_t interval_in_nanoseconds(double seconds) {
  return rounded_nanoseconds(std::max(seconds, 0.05));
}

}  // namespace leonav
