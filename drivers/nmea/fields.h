// These functions write times, angles and numbers as fields of NMEA 0183.
//
// A value is rounded as an integer in the unit of its last digit before it is split, so that no
// field ever shows 60 minutes of arc, or 60 seconds but in a leap second. What is not finite gives
// an empty field.
#pragma once
#include <string>

#include "core/base/gps_time.h"

namespace leonav {

// UTC as the fields of sentences have it.
struct UtcFields {
  std::string time;  // hhmmss.ss or hhmmss.sss; 235960.ss within an inserted leap second
  std::string day, month, year;                                      // dd, mm, yyyy
  std::string date() const { return day + month + year.substr(2); }  // ddmmyy
};

// Returns UTC of a GPS time, rounded to milliseconds, with the leap seconds of leap_seconds() (IERS
// Bulletin C). Hundredths of a second would be 10 cm of way at 20 m/s; they are written where the
// third decimal is zero.
UtcFields utc_fields(GpsTime time);

// Returns a number with so many decimals; never "-0".
std::string number_field(double value, int decimals);

// Returns an angle from `radians` in degrees from 0 to 359.99, clockwise, with two decimals.
std::string bearing_field(double radians);

// An angle on the ellipsoid as degrees and minutes to a millionth of a minute (2 mm), with its
// hemisphere.
struct PlaceFields {
  std::string angle, hemisphere;
};
PlaceFields latitude_fields(double radians);   // ddmm.mmmmmm, N or S
PlaceFields longitude_fields(double radians);  // dddmm.mmmmmm, E or W

}  // namespace leonav
