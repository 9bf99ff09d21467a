// Tropospheric delay of a standard atmosphere: Saastamoinen at zenith, Niell down to the horizon.
#pragma once
#include "core/earth/ellipsoid.h"
#include "core/time/gps_time.h"

namespace leonav {

// Relative humidity assumed where nothing is measured.
inline constexpr double kStandardHumidity = 0.5;

struct ZenithDelays {
  double hydrostatic_m = 0.0;
  double wet_m = 0.0;
};

// Saastamoinen (1972) with the pressure and temperature of the ICAO standard atmosphere at the
// antenna's height (taken as height above sea level; the geoid's 100 m make 3 cm). Heights are
// clamped to [-500 m, 11 km]: the troposphere above is worth less than 0.5 m and an aircraft's
// error stays far below the model's own.
ZenithDelays saastamoinen_zenith_delays(const Geodetic& antenna,
                                        double relative_humidity = kStandardHumidity);

struct TroposphereMapping {
  double hydrostatic = 1.0;
  double wet = 1.0;
};

// Niell (1996), "Global mapping functions for the atmosphere delay at radio wavelengths". An unset
// time leaves the seasonal term of the hydrostatic part out (up to 1 % at 5 degrees). Elevations
// below 1 degree are mapped as 1 degree: the fit ends at 3.
TroposphereMapping niell_mapping(const Geodetic& antenna, double elevation, GpsTime time = {});

// Slant delay in metres, to be subtracted from a measured range.
double saastamoinen_slant_delay_m(const Geodetic& antenna, double elevation, GpsTime time = {});

}  // namespace leonav
