// This unit represents rotations as matrices, unit quaternions, rotation vectors and Euler angles.
// C_ab rotates vectors from frame b to frame a; q_ab is the same rotation as a unit quaternion.
// Angles are in rad.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace leonav {

// [v x], so that skew(v) * w is the cross product v x w
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

// Returns exp([rotation_vector x]); it is stable at zero.
Eigen::Quaterniond quaternion_from_rotation_vector(const Eigen::Vector3d& rotation_vector);
Eigen::Vector3d rotation_vector_from_quaternion(const Eigen::Quaterniond& q);  // |result| <= pi

// Euler angles of the body (forward, right, down) against north, east, down: yaw about down comes
// first, then pitch, then roll.
struct EulerAngles {
  double roll = 0.0, pitch = 0.0, yaw = 0.0;  // rad; yaw in (-pi, pi], pitch in [-pi/2, pi/2]
};
Eigen::Matrix3d rotation_from_euler(const EulerAngles& angles);  // C_nb
EulerAngles euler_from_rotation(const Eigen::Matrix3d& C_nb);

// Returns the vector in axes that have turned by `angle` about z: from an inertial frame, or from
// the Earth-fixed one of another instant, to the Earth-fixed one.
Eigen::Vector3d rotate_about_z(const Eigen::Vector3d& v, double angle);

double wrap_to_pi(double angle);  // result in (-pi, pi]

}  // namespace leonav
