#include "tools/sim/motion/inertial_sensor.h"

#include <cmath>

namespace leonav {
namespace {

Eigen::Matrix3d leaning_axes(double sigma, GaussianGenerator* random) {
  Eigen::Matrix3d axes;
  for (Eigen::Index row = 0; row < 3; ++row) axes.row(row) = sigma * random->draw_three();
  axes.diagonal().setOnes();
  return axes;
}

// Returns whole steps of `quantum`; the remainder stays in `*left`.
Eigen::Vector3d quantized(const Eigen::Vector3d& value, double quantum, Eigen::Vector3d* left) {
  if (quantum == 0.0) return value;
  const Eigen::Vector3d due = value + *left;
  const Eigen::Vector3d given =
      quantum * (due / quantum).unaryExpr([](double steps) { return std::round(steps); });
  *left = due - given;
  return given;
}

}  // namespace

InertialSensor::InertialSensor(const ImuErrorModel& model, const ImuImperfections& imperfections,
                               double rate_hz, std::uint64_t seed, GaussianGenerator random)
    : imperfections_(imperfections),
      errors_(model, seed),
      gyro_axes_(leaning_axes(imperfections.gyro_misalignment, &random)),
      accel_axes_(leaning_axes(imperfections.accel_misalignment, &random)),
      gyro_per_k_(imperfections.gyro_bias_per_k * random.draw_three()),
      accel_per_k_(imperfections.accel_bias_per_k * random.draw_three()),
      vibration_(imperfections.vibration, rate_hz, random) {}

ImuSample InertialSensor::measure(const ImuSample& ideal, double speed_m_s) {
  const double dt = ideal.interval_s();
  ImuSample sample = ideal;
  if (imperfections_.vibration.active()) {
    const Vibration::Shaking shaking = vibration_.next(speed_m_s);
    sample.delta_theta_b += shaking.omega_b * dt;
    sample.delta_velocity_b += shaking.accel_b * dt;
  }
  sample.delta_theta_b = gyro_axes_ * sample.delta_theta_b;
  sample.delta_velocity_b = accel_axes_ * sample.delta_velocity_b;
  const double warmer_k = imperfections_.temperature_rise_k *
                          -std::expm1(-elapsed_s_ / imperfections_.temperature_time_s);
  sample = errors_.disturb(sample);
  sample.delta_theta_b += gyro_per_k_ * warmer_k * dt;
  sample.delta_velocity_b += accel_per_k_ * warmer_k * dt;
  sample.delta_theta_b = quantized(sample.delta_theta_b, imperfections_.gyro_quantum, &angle_left_);
  sample.delta_velocity_b =
      quantized(sample.delta_velocity_b, imperfections_.accel_quantum, &velocity_left_);
  elapsed_s_ += dt;
  return sample;
}

}  // namespace leonav
