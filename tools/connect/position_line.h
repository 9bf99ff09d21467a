// This function writes the line with a position that casters of network RTK ask for.
#pragma once
#include <string>

#include "core/base/gps_time.h"

namespace leonav {

// A place on WGS 84.
struct ReportedPosition {
  double latitude = 0.0, longitude = 0.0;  // rad
  double height_m = 0.0;                   // above the ellipsoid
};

// Returns a GGA sentence with its line end. Its talker is GP, because some casters read no other;
// quality, satellites and dilution are those of an ordinary fix (1, 12, 1.0), because casters
// refuse positions without one. The geoid separation is 0. Source: NMEA 0183 v4.10, GGA.
std::string position_line(const ReportedPosition& position, GpsTime time);

// The same at the time of the host's clock.
std::string position_line_now(const ReportedPosition& position);

}  // namespace leonav
