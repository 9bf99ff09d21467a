#include "core/filter/estimate/antenna_model.h"

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"

namespace leonav {

using Eigen::Vector3d;

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

}  // namespace leonav
