// Direction of a satellite as seen from an antenna.
#pragma once
#include <Eigen/Core>

namespace leonav {

struct LookAngles {
  double elevation = 0.0;  // rad above the ellipsoid's horizon, [-pi/2, pi/2]
  double azimuth = 0.0;    // rad clockwise from north, [0, 2 pi)
};

// Both positions ECEF of the same instant, m. An antenna at the satellite's own place gives zeros.
LookAngles look_angles(const Eigen::Vector3d& p_sat_e, const Eigen::Vector3d& p_a_e);

}  // namespace leonav
