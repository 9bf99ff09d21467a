// These functions read a day or an instant that a user has written.
#pragma once
#include <optional>
#include <string>

#include "core/base/gps_time.h"

namespace leonav {

// Returns noon (GPS time) of a day written as YYYY-MM-DD, 1980 to 2099; nullopt for any other text
// and for days that no month has.
std::optional<GpsTime> noon_of(const std::string& text);

// Returns the GPS time of a text YYYY-MM-DDThh:mm:ss.sss (a space in place of T, seconds and their
// decimals may be missing) whose hours are GPS time; nullopt for any other text.
std::optional<GpsTime> instant_of(const std::string& text);

}  // namespace leonav
