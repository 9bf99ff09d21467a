// Errors of a data sheet, drawn at random.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/ins/imu.h"
#include "core/ins/imu_error_model.h"
#include "tools/motion/gaussian_generator.h"

namespace leonav {

// Biases as first-order Gauss-Markov processes that start in their stationary state, white noise,
// constant scale factors.
class SensorErrors {
 public:
  SensorErrors(const ImuErrorModel& model, std::uint64_t seed);
  ImuSample disturb(const ImuSample& ideal);

 private:
  ImuErrorModel model_;
  GaussianGenerator noise_;
  Eigen::Vector3d gyro_bias_b_, accel_bias_b_, gyro_scale_, accel_scale_;
};

}  // namespace leonav
