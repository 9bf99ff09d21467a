#include "core/gnss/measurement/look_angles.h"

#include <cmath>
#include <numbers>

#include "core/earth/ellipsoid.h"

namespace leonav {

LookAngles look_angles(const Eigen::Vector3d& p_sat_e, const Eigen::Vector3d& p_a_e) {
  const Eigen::Vector3d line_of_sight_n =
      rotation_ecef_to_ned(to_geodetic(p_a_e)) * (p_sat_e - p_a_e);
  const double horizontal = std::hypot(line_of_sight_n.x(), line_of_sight_n.y());
  LookAngles angles;
  angles.elevation = std::atan2(-line_of_sight_n.z(), horizontal);
  if (horizontal > 0.0) angles.azimuth = std::atan2(line_of_sight_n.y(), line_of_sight_n.x());
  if (angles.azimuth < 0.0) angles.azimuth += 2.0 * std::numbers::pi;
  // An azimuth of -1e-17 plus 2 pi rounds to 2 pi itself, which is outside the range.
  if (angles.azimuth >= 2.0 * std::numbers::pi) angles.azimuth = 0.0;
  return angles;
}

}  // namespace leonav
