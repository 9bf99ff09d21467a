// IMU samples as increments over an interval, never as rates.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include "core/capacity.h"
#include "core/time/gps_time.h"

namespace leonav {

// Integrals of angular rate and specific force over (time - interval_ns, time], body frame
// forward-right-down, as the sensor delivered them (errors not removed).
struct ImuSample {
  GpsTime time;                                                // end of the interval
  std::int64_t interval_ns = 0;                                // > 0
  Eigen::Vector3d delta_theta_b = Eigen::Vector3d::Zero();     // rad
  Eigen::Vector3d delta_velocity_b = Eigen::Vector3d::Zero();  // m/s

  GpsTime start() const { return time.plus_nanoseconds(-interval_ns); }
  double interval_s() const { return static_cast<double>(interval_ns) * 1e-9; }
};

struct ImuSplit {
  ImuSample before;  // ends at the cut
  ImuSample after;   // starts at the cut
};
// Cuts a sample at `cut`, strictly inside its interval, in proportion to time: the parts'
// increments add up to the whole's, and their intervals exactly.
ImuSplit split(const ImuSample& sample, GpsTime cut);

using ImuBlock = boost::container::static_vector<ImuSample, kMaxImuBlock>;

}  // namespace leonav
