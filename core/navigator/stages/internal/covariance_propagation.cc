#include "core/navigator/stages/internal/covariance_propagation.h"

#include <algorithm>
#include <cmath>

#include "core/earth/rotation.h"

namespace leonav {
namespace {

using namespace ekf_index;

// Adds the random walk of the attitude, of density `noise` in rad/sqrt(s), which acts during the
// first `duration` seconds of the `t` seconds that end now. With velocity' = F attitude and
// position' = velocity it spreads to velocity and position. The integrals are over the age of the
// noise, from t - duration to t.
void add_attitude_random_walk(double noise, double duration, double t, const Eigen::Matrix3d& F,
                              PvaCovariance* P) {
  const double density = noise * noise, from = t - duration;
  const Eigen::Matrix3d FF = F * F.transpose();
  const auto integral = [&](int power) { return std::pow(t, power) - std::pow(from, power); };
  const auto add = [&](int row, int column, const Eigen::Matrix3d& block) {
    P->block<3, 3>(row, column) += density * block;
    if (row != column) P->block<3, 3>(column, row) += density * block.transpose();
  };
  add(kAttitude, kAttitude, duration * Eigen::Matrix3d::Identity());
  add(kVelocity, kAttitude, integral(2) / 2.0 * F);
  add(kVelocity, kVelocity, integral(3) / 3.0 * FF);
  add(kPosition, kAttitude, integral(3) / 6.0 * F);
  add(kPosition, kVelocity, integral(4) / 8.0 * FF);
  add(kPosition, kPosition, integral(5) / 20.0 * FF);
}

}  // namespace

using namespace ekf_index;

PvaCovariance inertial_covariance(const Anchor& anchor, const ImuErrorModel& imu,
                                  const Eigen::Vector3d& f_e, const Eigen::Matrix3d& C_eb,
                                  double elapsed_s) {
  // Errors are true minus estimate. Groves 2013, 14.2.3, without the Earth's rate, which changes
  // the angle by 1e-4 of it per second, and integrated for constant coefficients:
  //   attitude' = -C_eb gyro_bias,  velocity' = attitude x f_e - C_eb accel_bias,
  //   position' = velocity
  const double t = elapsed_s;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d F = -skew(f_e);
  Eigen::Matrix<double, 9, 15> transition = Eigen::Matrix<double, 9, 15>::Zero();
  transition.leftCols<9>().setIdentity();
  transition.block<3, 3>(kPosition, kVelocity) = t * I;
  transition.block<3, 3>(kPosition, kAttitude) = 0.5 * t * t * F;
  transition.block<3, 3>(kVelocity, kAttitude) = t * F;
  transition.block<3, 3>(kPosition, kGyroBias) = -t * t * t / 6.0 * F * C_eb;
  transition.block<3, 3>(kVelocity, kGyroBias) = -0.5 * t * t * F * C_eb;
  transition.block<3, 3>(kAttitude, kGyroBias) = -t * C_eb;
  transition.block<3, 3>(kPosition, kAccelBias) = -0.5 * t * t * C_eb;
  transition.block<3, 3>(kVelocity, kAccelBias) = -t * C_eb;
  PvaCovariance covariance =
      transition * anchor.covariance.topLeftCorner<15, 15>() * transition.transpose();
  add_acceleration_noise(imu.velocity_random_walk, t, &covariance);
  const double angle_variance = imu.angle_random_walk * imu.angle_random_walk * t;
  covariance.block<3, 3>(kAttitude, kAttitude) += angle_variance * I;
  if (anchor.random_walk.noise > 0.0) {
    const double left_s = seconds_between(anchor.random_walk.until, anchor.state.time);
    add_attitude_random_walk(anchor.random_walk.noise, std::clamp(left_s, 0.0, t), t, F,
                             &covariance);
  }
  return covariance;
}

PvaCovariance constant_velocity_covariance(const Anchor& anchor, double acceleration_noise,
                                           double elapsed_s) {
  PvaCovariance transition = PvaCovariance::Identity();
  transition.block<3, 3>(kPosition, kVelocity) = elapsed_s * Eigen::Matrix3d::Identity();
  PvaCovariance covariance =
      transition * anchor.covariance.topLeftCorner<9, 9>() * transition.transpose();
  add_acceleration_noise(acceleration_noise, elapsed_s, &covariance);
  return covariance;
}

void add_acceleration_noise(double acceleration_noise, double elapsed_s,
                            PvaCovariance* covariance) {
  const double q = acceleration_noise * acceleration_noise;
  const double t = elapsed_s;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  covariance->block<3, 3>(kPosition, kPosition) += q * t * t * t / 3.0 * I;
  covariance->block<3, 3>(kPosition, kVelocity) += q * t * t / 2.0 * I;
  covariance->block<3, 3>(kVelocity, kPosition) += q * t * t / 2.0 * I;
  covariance->block<3, 3>(kVelocity, kVelocity) += q * t * I;
}

}  // namespace leonav
