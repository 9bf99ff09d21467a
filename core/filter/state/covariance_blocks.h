// These functions give blocks of the filter's covariance, so that who reads one need not know the
// order of the error state.
#pragma once
#include <Eigen/Core>

#include "core/filter/state/ekf_state.h"

namespace leonav {

// The inertial error states: position, velocity, attitude, biases and scales.
using InertialCovariance = Eigen::Matrix<double, ekf_index::kInsSize, ekf_index::kInsSize>;

// Returns the covariance of the inertial error states.
inline InertialCovariance inertial_covariance(const EkfCovariance& P) {
  return P.topLeftCorner<ekf_index::kInsSize, ekf_index::kInsSize>();
}
// Returns the covariance of the position, ECEF, m^2.
inline Eigen::Matrix3d position_covariance_e(const EkfCovariance& P) {
  return P.block<3, 3>(ekf_index::kPosition, ekf_index::kPosition);
}
// Returns the covariance of the velocity, ECEF, (m/s)^2.
inline Eigen::Matrix3d velocity_covariance_e(const EkfCovariance& P) {
  return P.block<3, 3>(ekf_index::kVelocity, ekf_index::kVelocity);
}
// Returns the covariance of gyro bias, accelerometer bias, gyro scale and accelerometer scale.
inline ImuErrorCovariance imu_error_covariance(const EkfCovariance& P) {
  return P.block<12, 12>(ekf_index::kGyroBias, ekf_index::kGyroBias);
}
// Returns the variances of the gyro bias per body axis, (rad/s)^2.
inline Eigen::Vector3d gyro_bias_variances(const EkfCovariance& P) {
  return P.diagonal().segment<3>(ekf_index::kGyroBias);
}
// Returns the variance of the zenith wet delay, m^2; zero if it is not estimated.
inline double wet_delay_variance(const EkfCovariance& P) {
  return P(ekf_index::kWetDelay, ekf_index::kWetDelay);
}

}  // namespace leonav
