// This unit turns GPS time into UTC, as text and as Unix time.
#pragma once
#include <cstdint>
#include <string>

#include "core/base/gps_time.h"

namespace leonav {

// Returns UTC in nanoseconds since 1970-01-01 without leap seconds (Unix time). While a leap second
// is inserted, it is that of the second after it.
std::int64_t unix_nanoseconds(GpsTime time);

// Returns UTC as "2024-02-29T00:00:00.250Z" (ISO 8601), rounded to the nearest millisecond; a leap
// second as in Unix time, because XML Schema and most programs refuse a second 60.
std::string utc_text(GpsTime time);

}  // namespace leonav
