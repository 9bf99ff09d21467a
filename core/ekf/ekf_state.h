// The filter's error state: order, covariance, clocks.
#pragma once
#include <Eigen/Core>
#include <array>

#include "core/capacity.h"

namespace leonav {

// Error state, in this order (all errors are "true minus estimate"; position, velocity and attitude
// errors in ECEF: C_eb_true = exp([attitude x]) C_eb):
//   position 3, velocity 3, attitude 3, gyro bias 3, accelerometer bias 3, gyro scale 3,
//   accelerometer scale 3, clock offset per time base 4 (m), clock drift per time base 4 (m/s).
// The constant-velocity model keeps the same order; the states it lacks have zero covariance and
// take no correction.
namespace ekf_index {
inline constexpr int kPosition = 0, kVelocity = 3, kAttitude = 6, kGyroBias = 9, kAccelBias = 12,
                     kGyroScale = 15, kAccelScale = 18, kClock = 21, kClockDrift = 25, kSize = 29;
inline constexpr int kInsSize = 21;
}  // namespace ekf_index

using EkfCovariance = Eigen::Matrix<double, ekf_index::kSize, ekf_index::kSize>;
// Of gyro bias, accelerometer bias, gyro scale, accelerometer scale.
using ImuErrorCovariance = Eigen::Matrix<double, 12, 12>;
using EkfVector = Eigen::Matrix<double, ekf_index::kSize, 1>;

struct ClockState {
  Eigen::Vector4d offset_m = Eigen::Vector4d::Zero();
  Eigen::Vector4d drift_m_s = Eigen::Vector4d::Zero();
};

// Time bases observed so far, per System. An unobserved one has zero covariance and takes no
// correction until its first measurement starts it. A known offset implies a known drift.
struct ClockFlags {
  std::array<bool, kMaxTimeBases> offset{};
  std::array<bool, kMaxTimeBases> drift{};
};

}  // namespace leonav
