// These functions give the time: of the wall clock, by which messages are stamped, and one that is
// never set.
#pragma once
#include <cstdint>

namespace leonav {

// As LCM logs stamp it: microseconds since 1970.
std::int64_t wall_clock_us();

// Nanoseconds of a clock that never goes back; only differences have a meaning.
std::int64_t monotonic_ns();

}  // namespace leonav
