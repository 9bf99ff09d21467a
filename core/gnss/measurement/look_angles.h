// This unit computes the direction of a satellite as seen from an antenna.
#pragma once
#include <Eigen/Core>

namespace leonav {

// Direction of a satellite in the local frame of the antenna.
struct LookAngles {
  double elevation = 0.0;  // rad above the ellipsoid's horizon, [-pi/2, pi/2]
  double azimuth = 0.0;    // rad clockwise from north, [0, 2 pi)
};

// Both positions are ECEF of the same instant, in m. The result is zero where they coincide.
LookAngles look_angles(const Eigen::Vector3d& p_sat_e, const Eigen::Vector3d& p_a_e);

}  // namespace leonav
