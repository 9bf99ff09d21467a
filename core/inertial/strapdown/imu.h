// ImuSample holds the integrals of angular rate and specific force over one interval; rates never
// occur.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"

namespace leonav {

// Integrals of angular rate and specific force over (time - interval_ns, time]. They are in the
// body frame (forward, right, down), as the sensor delivered them; sensor errors are not removed.
struct ImuSample {
  GpsTime time;                                                // end of the interval
  std::int64_t interval_ns = 0;                                // > 0
  Eigen::Vector3d delta_theta_b = Eigen::Vector3d::Zero();     // rad
  Eigen::Vector3d delta_velocity_b = Eigen::Vector3d::Zero();  // m/s

  GpsTime start() const { return time.plus_nanoseconds(-interval_ns); }
  double interval_s() const { return static_cast<double>(interval_ns) * 1e-9; }
};

// The two parts of a sample that was cut.
struct ImuSplit {
  ImuSample before;  // ends at the cut
  ImuSample after;   // starts at the cut
};
// Cuts a sample at `cut` in proportion to time. Precondition: `cut` is strictly inside the
// interval. The increments of the parts add up to those of the whole, and their intervals do so
// exactly.
ImuSplit split(const ImuSample& sample, GpsTime cut);

using ImuBlock = boost::container::static_vector<ImuSample, kMaxImuBlock>;

}  // namespace leonav
