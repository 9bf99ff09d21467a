#include "tools/motion/sensor_errors.h"

#include <cmath>
#include <numbers>

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

double GaussianGenerator::uniform() {
  state_ += 0x9E3779B97F4A7C15ULL;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  z ^= z >> 31;
  return static_cast<double>((z >> 11) + 1) * 0x1.0p-53;
}

double GaussianGenerator::draw() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

Eigen::Vector3d GaussianGenerator::draw_three() {
  Eigen::Vector3d three;
  for (double& one : three) one = draw();
  return three;
}

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
