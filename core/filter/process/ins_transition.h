// InsTransition accumulates transition matrix and process noise of the 21 inertial error states.
#pragma once
#include <Eigen/Core>

#include "core/filter/state/ekf_state.h"
#include "core/filter/state/filter_process.h"
#include "core/inertial/strapdown/imu_error_model.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

// The input of the error equations from one IMU sample.
struct InsSample {
  Eigen::Matrix3d C_eb;        // at the middle of the interval
  Eigen::Vector3d f_b;         // mean specific force, errors removed, m/s^2
  Eigen::Vector3d omega_ib_b;  // mean rate, errors removed, rad/s
  double interval_s = 0.0;     // s
};

// Error equations of strapdown navigation in ECEF (Groves 2013, 14.2.3, with the sign of "true
// minus estimate" and with scale factors; psi is the attitude error):
//   p' = v
//   v' = -(C_eb f x) psi - 2 omega_ie x v + gamma p + C_eb df
//   psi' = -omega_ie x psi + C_eb dw
//   dw = -(bias error + w scale error + noise) / (1 + scale); df in the same way
//   biases and scales: first-order Gauss-Markov
// The matrix of each sample is multiplied onto the product so far through its 3 x 3 blocks, and the
// covariance is moved only once per sub-block: at 200 Hz, a tenth of the work.
class InsTransition {
 public:
  using Matrix = Eigen::Matrix<double, ekf_index::kInsSize, ekf_index::kInsSize>;

  // Starts a sub-block at identity. `errors` are those removed from the samples; `gamma` is the
  // gradient of gravity, ECEF, 1/s^2.
  void begin(const ImuErrorModel& model, const ImuErrors& errors, const Eigen::Matrix3d& gamma);
  void add(const InsSample& sample);

  double duration_s() const { return duration_s_; }
  Matrix transition() const;
  Matrix noise() const;

  // Applies P <- Phi P Phi^T + Q to the inertial states and their correlations with the others.
  void propagate(EkfCovariance* covariance) const;
  // Applies F <- Phi F to the inertial rows.
  void advance(ProcessMatrix* transition) const;

 private:
  Eigen::Matrix<double, ekf_index::kInsSize - 9, 1> error_decays() const;

  ImuErrorModel model_;
  Eigen::Array3d gyro_gain_ = Eigen::Array3d::Ones();  // 1 / (1 + scale)
  Eigen::Array3d accel_gain_ = Eigen::Array3d::Ones();
  Eigen::Matrix3d gamma_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 9, ekf_index::kInsSize> top_;    // rows of position, velocity, attitude
  Eigen::Matrix3d C_sum_ = Eigen::Matrix3d::Zero();      // integral of C_eb
  Eigen::Vector3d f_e_sum_ = Eigen::Vector3d::Zero();    // integral of C_eb f
  Eigen::Vector3d omega_sum_ = Eigen::Vector3d::Zero();  // integrals of the rate and specific force
  Eigen::Vector3d f_sum_ = Eigen::Vector3d::Zero();
  double duration_s_ = 0.0;
};

}  // namespace leonav
