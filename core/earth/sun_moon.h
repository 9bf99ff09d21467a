// This unit computes the positions of the Sun and the Moon, for tides and for the attitude of
// satellites.
#pragma once
#include <Eigen/Core>

#include "core/base/gps_time.h"

namespace leonav {

// Geometric positions (no light time, no aberration) from the Earth's centre in ECEF, m.
struct SunMoon {
  Eigen::Vector3d sun_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d moon_e = Eigen::Vector3d::Zero();
};

// Returns both positions at `time`. Directions are within 1.2e-4 rad (95 %; 2.2e-4 at worst),
// distances within 8e-5, from 1980 to 2060. Series: Meeus, Astronomical Algorithms (1998), chapters
// 25 (Sun) and 47 (Moon), referred to the equinox of date by the leading terms of nutation (chapter
// 22). Earth rotation: IAU 1982 sidereal time. UT1 is taken as UTC (they differ by less than 0.9 s,
// 7e-5 rad), polar motion as zero (2e-6 rad).
SunMoon sun_moon_positions(GpsTime time);

}  // namespace leonav
