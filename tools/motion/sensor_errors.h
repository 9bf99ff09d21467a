// Errors of a data sheet, drawn by a generator of our own: the same seed gives the same file with
// every compiler and standard library.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/ins/imu.h"
#include "core/ins/imu_error_model.h"

namespace leonav {

// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014) and the Box-Muller transform.
class GaussianGenerator {
 public:
  explicit GaussianGenerator(std::uint64_t seed) : state_(seed) {}
  double draw();                 // standard normal
  Eigen::Vector3d draw_three();  // in the order x, y, z

 private:
  double uniform();  // (0, 1]
  std::uint64_t state_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

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
