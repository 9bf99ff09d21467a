// Time systems by the names that products give them.
#pragma once
#include <string_view>

#include "core/time/gps_time.h"

namespace leonav {

// "GPS", "GAL", "QZS", "IRN" (all GPS time up to nanoseconds), "BDT", "BDS", "TAI", "UTC", "GLO".
bool is_known_time_system(std::string_view name);

// GPS time of an instant that a clock of the system reads as `reading` (a calendar read as GPS
// time). An unknown name counts as GPS.
GpsTime gps_time_of(GpsTime reading, std::string_view time_system);

}  // namespace leonav
