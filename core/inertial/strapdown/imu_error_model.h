// ImuErrorModel describes the errors of an IMU, as its data sheet gives them, in SI units. The
// configuration files use the units of data sheets.
#pragma once

namespace leonav {

// First-order Gauss-Markov process, given by its stationary sigma and its correlation time.
struct GaussMarkov {
  double sigma = 0.0;  // stationary 1 sigma, in the unit of the process
  double correlation_time_s = 3600.0;

  bool operator==(const GaussMarkov&) const = default;
};

// Noise densities, and bias and scale factor of every axis as Gauss-Markov processes.
struct ImuErrorModel {
  double angle_random_walk = 0.0;     // rad/sqrt(s)
  double velocity_random_walk = 0.0;  // m/s/sqrt(s)
  GaussMarkov gyro_bias;              // rad/s
  GaussMarkov accel_bias;             // m/s^2
  GaussMarkov gyro_scale;             // 1
  GaussMarkov accel_scale;            // 1

  bool operator==(const ImuErrorModel&) const = default;
};

// Returns the default, a consumer MEMS sensor. Assuming too poor an IMU costs accuracy; assuming
// too good a one makes the filter overconfident.
ImuErrorModel consumer_mems_errors();

}  // namespace leonav
