#include "core/gnss/orbits/satellite_attitude.h"

#include <Eigen/Geometry>

#include "core/earth/ellipsoid.h"

namespace leonav {
namespace {

constexpr double kSmallestSine = 1e-6;

Eigen::Matrix3d axes_from(const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
  Eigen::Matrix3d C_es;
  C_es.col(1) = y;
  C_es.col(2) = z;
  C_es.col(0) = y.cross(z);
  return C_es;
}

}  // namespace

AttitudeLaw attitude_law(SatelliteId satellite, AttitudeLaw leo) {
  if (satellite.system == System::kLeo) return leo;
  return is_beidou_geostationary(satellite) ? AttitudeLaw::kOrbitNormal : AttitudeLaw::kYawSteering;
}

Eigen::Matrix3d satellite_axes(const Eigen::Vector3d& p_sat_e, const Eigen::Vector3d& v_sat_e,
                               const Eigen::Vector3d& p_sun_e, AttitudeLaw law) {
  const double radius = p_sat_e.norm();
  if (!(radius > 0.0)) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d z = -p_sat_e / radius;
  if (law == AttitudeLaw::kYawSteering) {
    const Eigen::Vector3d y = z.cross((p_sun_e - p_sat_e).normalized());
    const double sine = y.norm();
    if (sine > kSmallestSine) return axes_from(y / sine, z);
  }
  // The orbital plane is fixed in inertial space, so the Earth's rotation is added to the velocity.
  const Eigen::Vector3d v_i =
      v_sat_e + kEarthRotationRate * Eigen::Vector3d::UnitZ().cross(p_sat_e);
  const Eigen::Vector3d y = z.cross(v_i);
  const double speed = y.norm();
  if (speed > kSmallestSine) return axes_from(y / speed, z);
  return axes_from(z.unitOrthogonal(), z);
}

}  // namespace leonav
