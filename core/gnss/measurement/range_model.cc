#include "core/gnss/measurement/range_model.h"

#include <Eigen/Geometry>

#include "core/earth/ellipsoid.h"

namespace leonav {

RangePrediction predict_range(const SatelliteGeometry& satellite, const Eigen::Vector3d& p_a_e) {
  const Eigen::Vector3d line = satellite.p_e - p_a_e;
  RangePrediction prediction;
  prediction.range_m = line.norm();
  prediction.d_range_d_p = -line.transpose() / prediction.range_m;
  return prediction;
}

// With the range rho = c tau, satellite and antenna in inertial space: rho = |x_s(t - tau) -
// x_a(t)|, hence rho' = u.(V_s (1 - rho'/c) - V_a). Solving for rho' gives the divisor. The Earth's
// rotation cancels in the numerator because omega x (x_s - x_a) is perpendicular to u.
RangeRatePrediction predict_range_rate(const SatelliteGeometry& satellite,
                                       const Eigen::Vector3d& p_a_e, const Eigen::Vector3d& v_a_e) {
  const Eigen::Vector3d line = satellite.p_e - p_a_e;
  const double range = line.norm();
  const Eigen::Vector3d u = line / range;
  const Eigen::Vector3d v_inertial =
      satellite.v_e + Eigen::Vector3d(0.0, 0.0, kEarthRotationRate).cross(satellite.p_e);
  const Eigen::Vector3d v_relative = satellite.v_e - v_a_e;
  const double divisor = 1.0 + u.dot(v_inertial) / kSpeedOfLight;

  RangeRatePrediction prediction;
  prediction.range_rate_m_s = u.dot(v_relative) / divisor;
  // du/dp_a = -(I - u u^T) / rho: the line of sight turns when the antenna moves across it.
  const Eigen::Vector3d across =
      v_relative - v_inertial * (prediction.range_rate_m_s / kSpeedOfLight);
  prediction.d_rate_d_p = -(across - u * u.dot(across)).transpose() / (range * divisor);
  prediction.d_rate_d_v = -u.transpose() / divisor;
  return prediction;
}

double line_of_sight_rate(const SatelliteGeometry& satellite, const Eigen::Vector3d& p_a_e) {
  const Eigen::Vector3d line = satellite.p_e - p_a_e;
  return line.cross(satellite.v_e).norm() / line.squaredNorm();
}

double correlation_time_ratio(double line_of_sight_rate) {
  constexpr double kMediumOrbit = 1.6e-4;  // rad/s: GPS overhead, the fastest in medium orbit
  return line_of_sight_rate > kMediumOrbit ? kMediumOrbit / line_of_sight_rate : 1.0;
}

}  // namespace leonav
