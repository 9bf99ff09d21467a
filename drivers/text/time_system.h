// This unit converts times from the time systems that products name.
#pragma once
#include <string_view>

#include "core/base/gps_time.h"

namespace leonav {

// Returns whether the name is one of "GPS", "GAL", "QZS", "IRN" (all GPS time up to nanoseconds),
// "BDT", "BDS", "TAI", "UTC", "GLO".
bool is_known_time_system(std::string_view name);

// Returns the GPS time of the instant at which a clock of the system shows `reading` (a calendar
// read as if it were GPS time). An unknown name counts as GPS.
GpsTime gps_time_of(GpsTime reading, std::string_view time_system);

}  // namespace leonav
