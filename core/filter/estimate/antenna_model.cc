#include "core/filter/estimate/antenna_model.h"

#include "core/earth/ellipsoid.h"

namespace leonav {

namespace {

using namespace ekf_index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d antenna_covariance_e(int first, bool estimated, const AntennaSlopes& slopes,
                              const EkfCovariance& P) {
  Matrix3d covariance = P.block<3, 3>(first, first);
  if (!estimated) return covariance;
  constexpr int kFirst = kSize + kLeverArm;
  const Matrix3d cross = slopes * P.block<kAntennaConstants, 3>(kFirst, first);
  covariance += cross + cross.transpose();
  covariance +=
      slopes * P.block<kAntennaConstants, kAntennaConstants>(kFirst, kFirst) * slopes.transpose();
  return covariance;
}

}  // namespace

AntennaMotion AntennaModel::motion(const FilterState& state, bool has_attitude,
                                   const BodyMotion& body) const {
  AntennaMotion motion = antenna_motion(state.nav, body.measured_rate_b, lever_arm_b_, has_attitude,
                                        state.vehicle, body.acceleration_e);
  if (!has_attitude) motion.p_e += offset_without_attitude_e(state.nav.p_e);
  return motion;
}

Vector3d AntennaModel::offset_without_attitude_e(const Vector3d& p_e) const {
  if (!vertical_arm_) return Vector3d::Zero();
  return rotation_ecef_to_ned(to_geodetic(p_e)).transpose() * Vector3d(0.0, 0.0, lever_arm_b_.z());
}

Matrix3d antenna_position_covariance_e(const AntennaMotion& antenna, const EkfCovariance& P) {
  return antenna_covariance_e(kPosition, antenna.estimated, antenna.d_p_d_constants, P);
}

Matrix3d antenna_velocity_covariance_e(const AntennaMotion& antenna, const EkfCovariance& P) {
  return antenna_covariance_e(kVelocity, antenna.estimated, antenna.d_v_d_constants, P);
}

}  // namespace leonav
