#include "core/navigator/interface/solution_conversion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/filter/ekf.h"

namespace leonav {
namespace {

// Returns the roots of the diagonal. A variance that rounding has made slightly negative gives
// zero, never NaN.
Eigen::Vector3d sqrt_of_diagonal(const Eigen::Matrix3d& covariance) {
  return covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
}

Eigen::Matrix3d rotated_block(const PvaCovariance& covariance, int first,
                              const Eigen::Matrix3d& C_ne) {
  return C_ne * covariance.block<3, 3>(first, first) * C_ne.transpose();
}

}  // namespace

Eigen::Vector3d sigma_of_euler(const Eigen::Matrix3d& attitude_covariance_n, double pitch,
                               double yaw) {
  // A small rotation is the sum of roll about the body's x axis, pitch about the intermediate y
  // axis and yaw about down. The columns are these axes in n.
  const double limit = std::numbers::pi;
  if (std::abs(std::cos(pitch)) < 1e-6) return Eigen::Vector3d::Constant(limit);
  Eigen::Matrix3d axes;
  axes.col(0) << std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), -std::sin(pitch);
  axes.col(1) << -std::sin(yaw), std::cos(yaw), 0.0;
  axes.col(2) << 0.0, 0.0, 1.0;
  const Eigen::Matrix3d inverse = axes.inverse();
  const Eigen::Matrix3d covariance = inverse * attitude_covariance_n * inverse.transpose();
  return sqrt_of_diagonal(covariance).cwiseMin(limit);
}

double norm_of_sigmas(const Eigen::Matrix3d& covariance) {
  const double trace = covariance.trace();
  return trace < 0.0 ? 0.0 : std::sqrt(trace);
}

bool is_finite(const Solution& solution) {
  const ImuErrors& errors = solution.errors;
  const Eigen::Vector4d scalars(solution.latitude, solution.longitude, solution.height,
                                solution.jump_m);
  const Eigen::Vector3d angles(solution.roll, solution.pitch, solution.yaw);
  return solution.p_e.allFinite() && solution.v_n.allFinite() && scalars.allFinite() &&
         angles.allFinite() && solution.sigma_p_n.allFinite() && solution.sigma_v_n.allFinite() &&
         solution.sigma_rpy.allFinite() && errors.gyro_bias_b.allFinite() &&
         errors.accel_bias_b.allFinite() && errors.gyro_scale.allFinite() &&
         errors.accel_scale.allFinite();
}

NavState at_stamp(const NavState& state, double time_offset_s) {
  NavState then = state;
  if (time_offset_s != 0.0) then.p_e -= time_offset_s * state.v_e;
  return then;
}

void fill_solution(const NavState& state, const PvaCovariance& covariance, bool has_attitude,
                   Solution* solution) {
  const Geodetic geodetic = to_geodetic(state.p_e);
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(geodetic);
  solution->time = state.time;
  solution->has_attitude = has_attitude;
  solution->p_e = state.p_e;
  solution->latitude = geodetic.latitude;
  solution->longitude = geodetic.longitude;
  solution->height = geodetic.height;
  solution->v_n = C_ne * state.v_e;
  solution->errors = state.errors;
  solution->sigma_p_n = sqrt_of_diagonal(rotated_block(covariance, ekf_index::kPosition, C_ne));
  solution->sigma_v_n = sqrt_of_diagonal(rotated_block(covariance, ekf_index::kVelocity, C_ne));
  solution->roll = solution->pitch = solution->yaw = 0.0;
  solution->sigma_rpy.setZero();
  if (!has_attitude) return;
  const Eigen::Matrix3d C_nb = C_ne * state.q_eb.toRotationMatrix();
  const EulerAngles euler = euler_from_rotation(C_nb);
  solution->roll = euler.roll;
  solution->pitch = euler.pitch;
  solution->yaw = euler.yaw;
  solution->sigma_rpy =
      sigma_of_euler(rotated_block(covariance, ekf_index::kAttitude, C_ne), euler.pitch, euler.yaw);
}

NominalError nominal_error(const PvaCovariance& covariance, const Solution& solution) {
  NominalError error;
  const Eigen::Matrix3d C_ne =
      rotation_ecef_to_ned({solution.latitude, solution.longitude, solution.height});
  error.position_covariance_n = rotated_block(covariance, ekf_index::kPosition, C_ne);
  if (solution.has_attitude) error.heading_variance = square(solution.sigma_rpy.z());
  return error;
}

void set_levels(const ProtectionLevels& levels, Solution* solution) {
  solution->horizontal_protection_m = levels.horizontal_m;
  solution->vertical_protection_m = levels.vertical_m;
  solution->heading_protection = levels.heading;
}

}  // namespace leonav
