// This unit models range and range rate between satellite and antenna, with Jacobians, for point
// solution, filter and smoother (Misra and Enge 2011, 5.1; range rate: docs/models/measurement.md).
//   range       rho  = |p_sat - p_a|
//   range rate  rho' = u.(v_sat - v_a) / (1 + u.V_sat / c)
// u is the unit vector from antenna to satellite, V_sat the satellite's velocity in inertial space.
// Satellite vectors are in the ECEF frame of reception (SatelliteInView), in m and m/s.
#pragma once
#include <Eigen/Core>

#include "core/gnss/measurement/measurement.h"

namespace leonav {

// A predicted range with its derivative.
struct RangePrediction {
  double range_m = 0.0;
  Eigen::RowVector3d d_range_d_p =
      Eigen::RowVector3d::Zero();  // with respect to antenna position, ECEF
};

// A predicted range rate with its derivatives.
struct RangeRatePrediction {
  double range_rate_m_s = 0.0;
  Eigen::RowVector3d d_rate_d_p = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d d_rate_d_v =
      Eigen::RowVector3d::Zero();  // with respect to antenna velocity, ECEF
};

// Predicts the range rho of an antenna at `p_a_e` (ECEF, m).
RangePrediction predict_range(const SatelliteGeometry& satellite, const Eigen::Vector3d& p_a_e);

// Predicts the range rate rho', the derivative of the range as the receiver's Doppler measures it.
// The divisor is the light-time term: 2 mm/s for GNSS, above 0.1 m/s for LEO.
RangeRatePrediction predict_range_rate(const SatelliteGeometry& satellite,
                                       const Eigen::Vector3d& p_a_e, const Eigen::Vector3d& v_a_e);

// Returns the ratio of this satellite's correlation time to that of a satellite in medium orbit.
// The errors depend on the direction of the satellite (reflections, ionosphere, projection of the
// orbit error), so the ratio is 1 for the slower satellites and about 1/50 for LEO overhead.
double correlation_time_ratio(double line_of_sight_rate);
// Returns how fast the direction of the satellite turns as seen from the antenna, rad/s.
double line_of_sight_rate(const SatelliteGeometry& satellite, const Eigen::Vector3d& p_a_e);

}  // namespace leonav
