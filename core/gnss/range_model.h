// Range and range rate between a satellite and an antenna, with Jacobians. Shared by the point
// solution, the filter and the smoother.
#pragma once
#include <Eigen/Core>

#include "core/gnss/measurement.h"

namespace leonav {

struct RangePrediction {
  double range_m = 0.0;
  Eigen::RowVector3d d_range_d_p =
      Eigen::RowVector3d::Zero();  // with respect to antenna position, ECEF
};

struct RangeRatePrediction {
  double range_rate_m_s = 0.0;
  Eigen::RowVector3d d_rate_d_p = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d d_rate_d_v =
      Eigen::RowVector3d::Zero();  // with respect to antenna velocity, ECEF
};

// |p_sat - p_a|; satellite vectors already in the frame of reception (SatelliteInView).
RangePrediction predict_range(const SatelliteInView& satellite, const Eigen::Vector3d& p_a_e);

// d/dt of the range as the receiver's Doppler sees it: u.(v_sat - v_a) / (1 + u.v_sat_inertial /
// c). The divisor is the light-time term: 2 mm/s for GNSS, above 0.1 m/s for LEO.
RangeRatePrediction predict_range_rate(const SatelliteInView& satellite,
                                       const Eigen::Vector3d& p_a_e, const Eigen::Vector3d& v_a_e);

// For how much shorter a time than those of a satellite in medium orbit this one's errors stay
// alike, which hang on the direction it is seen in (reflections, the ionosphere, how its orbit's
// errors project): 1 for the slower ones, about 1/50 for LEO overhead.
double persistence(const SatelliteInView& satellite, const Eigen::Vector3d& p_a_e);

}  // namespace leonav
