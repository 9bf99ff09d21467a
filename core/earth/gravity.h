// This unit computes plumb-line gravity and its gradient in ECEF, for inertial navigation.
#pragma once
#include <Eigen/Core>

namespace leonav {

// Returns the plumb-line gravity (gravitation plus centrifugal acceleration) at `p_e` (ECEF, m) in
// ECEF axes, m/s^2. It is the normal gravity of the WGS84 ellipsoid with height, exact in closed
// form (Hofmann-Wellenhof & Moritz, Physical Geodesy, 2nd ed., 2.8: the normal potential in
// ellipsoidal coordinates).
Eigen::Vector3d gravity_e(const Eigen::Vector3d& p_e);

// Returns d gravity_e / d p_e in 1/s^2, from the spherical gradient plus the centrifugal term; the
// relative error is below 1 %.
Eigen::Matrix3d gravity_gradient_e(const Eigen::Vector3d& p_e);

}  // namespace leonav
