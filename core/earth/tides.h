// This unit computes how the tides displace a point that is fixed to the Earth's crust. The
// displacement is added to the tide-free coordinates of a marker to get its present position. All
// results are in ECEF, m.
#pragma once
#include <Eigen/Core>
#include <array>

#include "core/base/gps_time.h"
#include "core/earth/sun_moon.h"

namespace leonav {

// Returns the solid Earth tide at `p_e` (any point; one below 6000 km from the Earth's centre gives
// zero). Source: IERS Conventions (2010), 7.1.1: degree 2 with Love numbers that depend on
// latitude, degree 3, the out-of-phase parts of the diurnal and semi-diurnal band, the latitude
// dependence of the horizontal part, and of the step-2 corrections every term of 0.05 mm or more
// (K1, the largest, has 12 mm). The permanent tide is included, as in the coordinates of the ITRF
// ("conventional tide free").
Eigen::Vector3d solid_earth_tide(const Eigen::Vector3d& p_e, GpsTime time, const SunMoon& bodies);

// Ocean loading of one station: amplitude and phase (Greenwich, lag positive) of eleven
// constituents in the order of the BLQ format. Rows are up, west, south.
struct OceanLoading {
  enum Constituent { kM2, kS2, kN2, kK2, kK1, kO1, kP1, kQ1, kMf, kMm, kSsa };
  static constexpr int kConstituents = 11;
  Eigen::Matrix<double, 3, kConstituents> amplitude_m = decltype(amplitude_m)::Zero();
  Eigen::Matrix<double, 3, kConstituents> phase = decltype(phase)::Zero();  // rad

  bool operator==(const OceanLoading&) const = default;
};

// Returns the sum of the eleven waves with the arguments of Schwiderski (IERS Conventions 1996,
// chapter 7). Side lobes and nodal factors are left out: they are up to a tenth of the loading
// itself, which is millimetres inland and centimetres at open coasts.
Eigen::Vector3d ocean_loading_displacement(const Eigen::Vector3d& p_e, GpsTime time,
                                           const OceanLoading& loading);

// Position of the rotation axis, as published in IERS Bulletin A and series C04.
struct PolarMotion {
  double xp = 0.0;  // rad, towards Greenwich
  double yp = 0.0;  // rad, towards 90 degrees west

  bool operator==(const PolarMotion&) const = default;
};

// Returns the deformation by the distance of the rotation axis from the secular pole: IERS
// Conventions (2010, updated 2018), eqs. 7.21, 7.25, 7.26. It is at most some 25 mm.
Eigen::Vector3d pole_tide(const Eigen::Vector3d& p_e, GpsTime time, const PolarMotion& pole);

}  // namespace leonav
