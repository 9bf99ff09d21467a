// How the tides move a point that is fixed to the Earth's crust. Add the displacement to the
// tide-free coordinates of a marker to get where it is now. All results in ECEF, m.
#pragma once
#include <Eigen/Core>
#include <array>

#include "core/earth/sun_moon.h"
#include "core/time/gps_time.h"

namespace leonav {

// Solid Earth tide at `p_e` (any point; one below 6000 km from the Earth's centre gives zero). IERS
// Conventions (2010), 7.1.1: degree 2 with Love numbers that depend on latitude, degree 3, the
// out-of-phase parts of the diurnal and semi-diurnal band, the latitude dependence of the
// horizontal part, and of the step-2 corrections every term of 0.05 mm or more (K1, the largest,
// has 12 mm). The permanent tide is included, as in the coordinates of the ITRF ("conventional tide
// free").
Eigen::Vector3d solid_earth_tide(const Eigen::Vector3d& p_e, GpsTime time, const SunMoon& bodies);

// Ocean loading of one station: amplitude and phase (Greenwich, lag positive) of eleven
// constituents as the BLQ format has them, rows up, west, south.
struct OceanLoading {
  enum Constituent { kM2, kS2, kN2, kK2, kK1, kO1, kP1, kQ1, kMf, kMm, kSsa };
  static constexpr int kConstituents = 11;
  Eigen::Matrix<double, 3, kConstituents> amplitude_m = decltype(amplitude_m)::Zero();
  Eigen::Matrix<double, 3, kConstituents> phase = decltype(phase)::Zero();  // rad
};

// Sum of the eleven waves with the arguments of Schwiderski (IERS Conventions 1996, chapter 7).
// Side lobes and nodal factors are left out: up to a tenth of the loading itself, which is
// millimetres inland and centimetres at open coasts.
Eigen::Vector3d ocean_loading_displacement(const Eigen::Vector3d& p_e, GpsTime time,
                                           const OceanLoading& loading);

// Where the rotation axis is, as IERS Bulletins A and C04 give it.
struct PolarMotion {
  double xp = 0.0;  // rad, towards Greenwich
  double yp = 0.0;  // rad, towards 90 degrees west
};

// Deformation by the rotation axis's distance from the secular pole: IERS Conventions (2010,
// updated 2018), eqs. 7.21, 7.25, 7.26. Some 25 mm at most.
Eigen::Vector3d pole_tide(const Eigen::Vector3d& p_e, GpsTime time, const PolarMotion& pole);

}  // namespace leonav
