// Gravity as an inertial navigator needs it.
#pragma once
#include <Eigen/Core>

namespace leonav {

// Plumb-line gravity (gravitation plus centrifugal acceleration) in ECEF, m/s^2. Normal gravity of
// the WGS84 ellipsoid with height, exact in closed form (Hofmann-Wellenhof & Moritz, Physical
// Geodesy, 2nd ed., 2.8, the normal potential in ellipsoidal coordinates).
Eigen::Vector3d gravity_e(const Eigen::Vector3d& p_e);

// d gravity_e / d p_e, 1/s^2; spherical gradient plus centrifugal term: relative error below 1 %.
Eigen::Matrix3d gravity_gradient_e(const Eigen::Vector3d& p_e);

}  // namespace leonav
