#include "core/filter/process/ins_transition.h"

#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

double decay(const GaussMarkov& process, double dt) {
  return std::exp(-dt / process.correlation_time_s);
}

// Variance that keeps the process stationary over `dt`.
double driving_variance(const GaussMarkov& process, double dt) {
  return -process.sigma * process.sigma * std::expm1(-2.0 * dt / process.correlation_time_s);
}

Matrix3d omega_ie_skew() { return skew(Vector3d{0.0, 0.0, kEarthRotationRate}); }

}  // namespace

void InsTransition::begin(const ImuErrorModel& model, const ImuErrors& errors,
                          const Matrix3d& gamma) {
  model_ = model;
  gyro_gain_ = (1.0 + errors.gyro_scale.array()).inverse();
  accel_gain_ = (1.0 + errors.accel_scale.array()).inverse();
  gamma_ = gamma;
  top_.setIdentity();
  C_sum_.setZero();
  f_e_sum_.setZero();
  omega_sum_.setZero();
  f_sum_.setZero();
  duration_s_ = 0.0;
}

void InsTransition::add(const InsSample& sample) {
  const double dt = sample.interval_s;
  const double middle = duration_s_ + 0.5 * dt;
  const Vector3d f_e = sample.C_eb * sample.f_b;
  const Matrix3d C_gyro = sample.C_eb * gyro_gain_.matrix().asDiagonal();
  const Matrix3d C_accel = sample.C_eb * accel_gain_.matrix().asDiagonal();
  const Matrix3d Omega = omega_ie_skew();
  const Eigen::Matrix<double, 9, kInsSize> before = top_;

  // Attitude first, then velocity with the mean attitude, then position with the mean velocity:
  // second order in dt.
  auto attitude = top_.middleRows<3>(kAttitude);
  attitude.noalias() -= dt * Omega * before.middleRows<3>(kAttitude);
  attitude.middleCols<3>(kGyroBias) -= dt * decay(model_.gyro_bias, middle) * C_gyro;
  attitude.middleCols<3>(kGyroScale) -=
      dt * decay(model_.gyro_scale, middle) * C_gyro * sample.omega_ib_b.asDiagonal();

  auto velocity = top_.middleRows<3>(kVelocity);
  velocity.noalias() -= (0.5 * dt * skew(f_e)) * (before.middleRows<3>(kAttitude) + attitude);
  velocity.noalias() -= (2.0 * dt * Omega) * before.middleRows<3>(kVelocity);
  velocity.noalias() += (dt * gamma_) * before.middleRows<3>(kPosition);
  velocity.middleCols<3>(kAccelBias) -= dt * decay(model_.accel_bias, middle) * C_accel;
  velocity.middleCols<3>(kAccelScale) -=
      dt * decay(model_.accel_scale, middle) * C_accel * sample.f_b.asDiagonal();

  top_.middleRows<3>(kPosition) += 0.5 * dt * (before.middleRows<3>(kVelocity) + velocity);

  C_sum_ += dt * sample.C_eb;
  f_e_sum_ += dt * f_e;
  omega_sum_ += dt * sample.omega_ib_b;
  f_sum_ += dt * sample.f_b;
  duration_s_ += dt;
}

InsTransition::Matrix InsTransition::transition() const {
  Matrix phi = Matrix::Zero();
  phi.topRows<9>() = top_;
  for (int axis = 0; axis < 3; ++axis) {
    phi(kGyroBias + axis, kGyroBias + axis) = decay(model_.gyro_bias, duration_s_);
    phi(kAccelBias + axis, kAccelBias + axis) = decay(model_.accel_bias, duration_s_);
    phi(kGyroScale + axis, kGyroScale + axis) = decay(model_.gyro_scale, duration_s_);
    phi(kAccelScale + axis, kAccelScale + axis) = decay(model_.accel_scale, duration_s_);
  }
  return phi;
}

// White noise of rate and specific force integrated through the error equations with the mean
// specific force of the sub-block; the noise that drives biases and scales with its first integral.
InsTransition::Matrix InsTransition::noise() const {
  Matrix Q = Matrix::Zero();
  const double t = duration_s_;
  if (t <= 0.0) return Q;
  const double gyro = model_.angle_random_walk * model_.angle_random_walk;
  const double accel = model_.velocity_random_walk * model_.velocity_random_walk;
  const Matrix3d I = Matrix3d::Identity();
  const Matrix3d M = -skew(f_e_sum_ / t);  // d velocity' / d attitude
  const Matrix3d MM = M * M.transpose();

  Q.block<3, 3>(kAttitude, kAttitude) = gyro * t * I;
  Q.block<3, 3>(kVelocity, kAttitude) = gyro * t * t / 2.0 * M;
  Q.block<3, 3>(kPosition, kAttitude) = gyro * t * t * t / 6.0 * M;
  Q.block<3, 3>(kVelocity, kVelocity) = accel * t * I + gyro * t * t * t / 3.0 * MM;
  Q.block<3, 3>(kPosition, kVelocity) = accel * t * t / 2.0 * I + gyro * t * t * t * t / 8.0 * MM;
  Q.block<3, 3>(kPosition, kPosition) =
      accel * t * t * t / 3.0 * I + gyro * t * t * t * t * t / 20.0 * MM;

  const double gyro_bias = driving_variance(model_.gyro_bias, t);
  const double accel_bias = driving_variance(model_.accel_bias, t);
  const double gyro_scale = driving_variance(model_.gyro_scale, t);
  const double accel_scale = driving_variance(model_.accel_scale, t);
  Q.block<3, 3>(kGyroBias, kGyroBias) = gyro_bias * I;
  Q.block<3, 3>(kAccelBias, kAccelBias) = accel_bias * I;
  Q.block<3, 3>(kGyroScale, kGyroScale) = gyro_scale * I;
  Q.block<3, 3>(kAccelScale, kAccelScale) = accel_scale * I;
  const Matrix3d C_gyro = 0.5 * C_sum_ * gyro_gain_.matrix().asDiagonal();
  const Matrix3d C_accel = 0.5 * C_sum_ * accel_gain_.matrix().asDiagonal();
  Q.block<3, 3>(kAttitude, kGyroBias) = -gyro_bias * C_gyro;
  Q.block<3, 3>(kAttitude, kGyroScale) = -gyro_scale / t * C_gyro * omega_sum_.asDiagonal();
  Q.block<3, 3>(kVelocity, kAccelBias) = -accel_bias * C_accel;
  Q.block<3, 3>(kVelocity, kAccelScale) = -accel_scale / t * C_accel * f_sum_.asDiagonal();
  // Their second integrals keep Q positive semidefinite beside the first ones.
  Q.block<3, 3>(kAttitude, kAttitude) += gyro_bias / 3.0 * t * t * I;
  Q.block<3, 3>(kVelocity, kVelocity) += accel_bias / 3.0 * t * t * I;
  Q.block<3, 3>(kAttitude, kAttitude) += 4.0 / 3.0 * gyro_scale / (t * t) * C_gyro *
                                         omega_sum_.cwiseAbs2().asDiagonal() * C_gyro.transpose();
  Q.block<3, 3>(kVelocity, kVelocity) += 4.0 / 3.0 * accel_scale / (t * t) * C_accel *
                                         f_sum_.cwiseAbs2().asDiagonal() * C_accel.transpose();
  Q.triangularView<Eigen::StrictlyLower>() = Q.transpose();
  return Q;
}

Eigen::Matrix<double, kInsSize - 9, 1> InsTransition::error_decays() const {
  Eigen::Matrix<double, kInsSize - 9, 1> decays;
  decays << Vector3d::Constant(decay(model_.gyro_bias, duration_s_)),
      Vector3d::Constant(decay(model_.accel_bias, duration_s_)),
      Vector3d::Constant(decay(model_.gyro_scale, duration_s_)),
      Vector3d::Constant(decay(model_.accel_scale, duration_s_));
  return decays;
}

void InsTransition::advance(ProcessMatrix* transition) const {
  if (duration_s_ <= 0.0) return;
  BoundedMatrix<9, kMaxSize + 1> rows;
  rows.noalias() = top_ * transition->topRows<kInsSize>();
  transition->middleRows<kInsSize - 9>(9) =
      error_decays().asDiagonal() * transition->middleRows<kInsSize - 9>(9);
  transition->topRows<9>() = rows;
}

void InsTransition::propagate(EkfCovariance* covariance) const {
  if (duration_s_ <= 0.0) return;
  EkfCovariance& P = *covariance;
  const Eigen::Matrix<double, kInsSize - 9, 1> decays = error_decays();

  // Phi P: the upper nine rows are full, the rows of biases and scales only shrink.
  BoundedMatrix<9, kMaxSize> rows;
  rows.noalias() = top_ * P.topRows<kInsSize>();
  P.middleRows<kInsSize - 9>(9) = decays.asDiagonal() * P.middleRows<kInsSize - 9>(9);
  P.topRows<9>() = rows;
  // (Phi P) Phi^T, in the same way by columns.
  BoundedMatrix<kMaxSize, 9> columns;
  columns.noalias() = P.leftCols<kInsSize>() * top_.transpose();
  P.middleCols<kInsSize - 9>(9) = P.middleCols<kInsSize - 9>(9) * decays.asDiagonal();
  P.leftCols<9>() = columns;
  P.topLeftCorner<kInsSize, kInsSize>() += noise();
  P.triangularView<Eigen::StrictlyLower>() = P.transpose();
}

}  // namespace leonav
