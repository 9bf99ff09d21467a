// SensorErrors draws the errors of a data sheet at random.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/inertial/strapdown/imu.h"
#include "core/inertial/strapdown/imu_error_model.h"
#include "tools/sim/motion/gaussian_generator.h"

namespace leonav {

// Biases are first-order Gauss-Markov processes that start in their stationary state; noise is
// white, scale factors are constant.
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
