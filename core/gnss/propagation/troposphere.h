// This unit models the tropospheric delay of a standard atmosphere: Saastamoinen at zenith, mapped
// by Niell down to the horizon.
#pragma once
#include "core/base/gps_time.h"
#include "core/earth/ellipsoid.h"

namespace leonav {

// Relative humidity assumed where it is not measured.
inline constexpr double kStandardHumidity = 0.5;

// Zenith delays of the two parts of the atmosphere.
struct ZenithDelays {
  double hydrostatic_m = 0.0;
  double wet_m = 0.0;
};

// Returns the zenith delays of Saastamoinen (1972) with the pressure and temperature of the ICAO
// standard atmosphere at the antenna's height. The height is taken as height above sea level (the
// geoid's 100 m make 3 cm) and clamped to [-500 m, 11 km]: above, the troposphere contributes less
// than 0.5 m, and an aircraft's error stays far below the error of the model.
ZenithDelays saastamoinen_zenith_delays(const Geodetic& antenna,
                                        double relative_humidity = kStandardHumidity);

// Ratios of the slant delay to the zenith delay.
struct TroposphereMapping {
  double hydrostatic = 1.0;
  double wet = 1.0;
};

// Returns the mapping functions of Niell (1996), "Global mapping functions for the atmosphere delay
// at radio wavelengths", at `elevation` (rad). An unset time leaves out the seasonal term of the
// hydrostatic part (up to 1 % at 5 degrees). Elevations below 1 degree are mapped as 1 degree; the
// fit ends at 3 degrees.
TroposphereMapping niell_mapping(const Geodetic& antenna, double elevation, GpsTime time = {});

// Returns the slant delay in metres, to be subtracted from a measured range; `elevation` is in rad.
double saastamoinen_slant_delay_m(const Geodetic& antenna, double elevation, GpsTime time = {});

}  // namespace leonav
