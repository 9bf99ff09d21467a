#include "core/earth/rotation.h"

#include <cmath>
#include <numbers>

namespace leonav {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(),  //
      v.z(), 0.0, -v.x(),   //
      -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond quaternion_from_rotation_vector(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  const double half = 0.5 * angle;
  // The factor is sin(x/2)/x; where the series is used, its next term is below 1e-17 of the first.
  const double sine_ratio = angle < 1e-4 ? 0.5 - angle * angle / 48.0 : std::sin(half) / angle;
  const Eigen::Vector3d vector = sine_ratio * rotation_vector;
  return {std::cos(half), vector.x(), vector.y(), vector.z()};
}

Eigen::Vector3d rotation_vector_from_quaternion(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  // q and -q are the same rotation: the shorter way is taken
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  if (sine < 1e-9) return 2.0 * sign * q.vec();
  return (2.0 * std::atan2(sine, std::abs(q.w())) * sign / sine) * q.vec();
}

Eigen::Matrix3d rotation_from_euler(const EulerAngles& angles) {
  const double sr = std::sin(angles.roll), cr = std::cos(angles.roll);
  const double sp = std::sin(angles.pitch), cp = std::cos(angles.pitch);
  const double sy = std::sin(angles.yaw), cy = std::cos(angles.yaw);
  Eigen::Matrix3d C_nb;
  C_nb << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,      //
      -sp, cp * sr, cp * cr;
  return C_nb;
}

EulerAngles euler_from_rotation(const Eigen::Matrix3d& C_nb) {
  EulerAngles angles;
  const double cos_pitch = std::hypot(C_nb(0, 0), C_nb(1, 0));
  angles.pitch = std::atan2(-C_nb(2, 0), cos_pitch);
  if (cos_pitch > 1e-12) {
    angles.roll = std::atan2(C_nb(2, 1), C_nb(2, 2));
    angles.yaw = wrap_to_pi(std::atan2(C_nb(1, 0), C_nb(0, 0)));
  } else {
    // The nose points straight up or down: only yaw -/+ roll is defined, and it is assigned to yaw.
    angles.yaw = wrap_to_pi(std::atan2(-C_nb(0, 1), C_nb(1, 1)));
  }
  return angles;
}

Eigen::Vector3d rotate_about_z(const Eigen::Vector3d& v, double angle) {
  const double s = std::sin(angle), c = std::cos(angle);
  return {c * v.x() + s * v.y(), -s * v.x() + c * v.y(), v.z()};
}

double wrap_to_pi(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

}  // namespace leonav
