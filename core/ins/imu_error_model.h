// How an IMU errs, from its data sheet. SI units here; config/ has the data sheet's units.
#pragma once

namespace leonav {

// First-order Gauss-Markov: stationary sigma and correlation time.
struct GaussMarkov {
  double sigma = 0.0;  // stationary 1 sigma
  double correlation_time_s = 3600.0;
};

struct ImuErrorModel {
  double angle_random_walk = 0.0;     // rad/sqrt(s)
  double velocity_random_walk = 0.0;  // m/s/sqrt(s)
  GaussMarkov gyro_bias;              // rad/s
  GaussMarkov accel_bias;             // m/s^2
  GaussMarkov gyro_scale;             // 1
  GaussMarkov accel_scale;            // 1
};

}  // namespace leonav
