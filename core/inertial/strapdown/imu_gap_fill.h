// This unit fills short gaps in the IMU stream with interpolated increments and gives their
// uncertainty.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/inertial/strapdown/imu.h"

namespace leonav {

// Longest gap that is filled. A vehicle hardly changes its rates over so long; over longer gaps the
// neighbouring samples give no information about the motion in between.
inline constexpr double kMaxImuGap_s = 0.2;

// What is integrated over a gap, with its uncertainty.
struct ImuGapFill {
  ImuSample sample;  // from the beginning of the gap to its end, sensor errors not removed
  // 1 sigma of the sample's increments beyond the sensor's noise, body axes.
  Eigen::Vector3d sigma_theta_b = Eigen::Vector3d::Zero();     // rad
  Eigen::Vector3d sigma_velocity_b = Eigen::Vector3d::Zero();  // m/s
};

// Fills the gap (from, to] at the rates of the last sample before it and the first after it.
//
// The rates are linear in time between the middles of the two samples, or constant where only one
// is known; an interval of 0 marks an unknown neighbour. The sigma is the gap times half the change
// of rate, plus the effect of a vehicle's angular acceleration and jerk in between. Returns nullopt
// if the whole gap between the two samples, not only the part to fill, is longer than kMaxImuGap_s,
// or if neither neighbour is known.
std::optional<ImuGapFill> fill_imu_gap(const ImuSample& previous, GpsTime from, GpsTime to,
                                       const ImuSample& next);

}  // namespace leonav
