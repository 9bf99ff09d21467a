// What to integrate where IMU samples are missing.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/ins/imu.h"

namespace leonav {

// Between its neighbours a vehicle hardly changes its rates over so long; beyond, they say nothing
// about what happened in between.
inline constexpr double kLongestBridge_s = 0.2;

struct Bridge {
  ImuSample filler;  // from the beginning of the hole to its end, sensor errors not removed
  // 1 sigma of its increments beyond a sensor's own noise, body axes.
  Eigen::Vector3d sigma_theta_b = Eigen::Vector3d::Zero();     // rad
  Eigen::Vector3d sigma_velocity_b = Eigen::Vector3d::Zero();  // m/s
};

// Fills (from, to] at the rates of the last sample before it and the first after it, linear in time
// between their middles, or at those of the one that is known; an interval of 0 means unknown. The
// sigma is the hole times half the change of rate, plus what a vehicle's angular acceleration and
// jerk may do in between. Nothing where the whole hole, between the samples and not only the part
// asked for, is longer than kLongestBridge_s, or neither neighbour is known.
std::optional<Bridge> bridge_hole(const ImuSample& previous, GpsTime from, GpsTime to,
                                  const ImuSample& next);

}  // namespace leonav
