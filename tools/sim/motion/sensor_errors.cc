#include "tools/sim/motion/sensor_errors.h"

#include <cmath>

namespace leonav {
namespace {

Eigen::Vector3d evolve(const Eigen::Vector3d& value, const GaussMarkov& process, double dt,
                       GaussianGenerator* noise) {
  const double decay = std::exp(-dt / process.correlation_time_s);
  const double driving =
      process.sigma * std::sqrt(-std::expm1(-2.0 * dt / process.correlation_time_s));
  return decay * value + driving * noise->draw_three();
}

}  // namespace

SensorErrors::SensorErrors(const ImuErrorModel& model, std::uint64_t seed)
    : model_(model), noise_(seed) {
  gyro_bias_b_ = model_.gyro_bias.sigma * noise_.draw_three();
  accel_bias_b_ = model_.accel_bias.sigma * noise_.draw_three();
  gyro_scale_ = model_.gyro_scale.sigma * noise_.draw_three();
  accel_scale_ = model_.accel_scale.sigma * noise_.draw_three();
}

ImuSample SensorErrors::disturb(const ImuSample& ideal) {
  const double dt = ideal.interval_s(), root = std::sqrt(dt);
  ImuSample sample = ideal;
  sample.delta_theta_b += gyro_scale_.cwiseProduct(ideal.delta_theta_b) + gyro_bias_b_ * dt;
  sample.delta_theta_b += model_.angle_random_walk * root * noise_.draw_three();
  sample.delta_velocity_b += accel_scale_.cwiseProduct(ideal.delta_velocity_b) + accel_bias_b_ * dt;
  sample.delta_velocity_b += model_.velocity_random_walk * root * noise_.draw_three();
  gyro_bias_b_ = evolve(gyro_bias_b_, model_.gyro_bias, dt, &noise_);
  accel_bias_b_ = evolve(accel_bias_b_, model_.accel_bias, dt, &noise_);
  return sample;
}

}  // namespace leonav
