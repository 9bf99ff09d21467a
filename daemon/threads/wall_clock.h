// Messages of the daemon are stamped with the wall-clock time.
#pragma once
#include <cstdint>

namespace leonav {

// As LCM logs stamp it: microseconds since 1970.
std::int64_t wall_clock_us();

}  // namespace leonav
