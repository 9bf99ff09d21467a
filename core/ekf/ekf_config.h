// Tuning of the extended Kalman filter. SI units.
#pragma once
#include "core/gnss/igg3.h"
#include "core/ins/imu_error_model.h"

namespace leonav {

enum class MotionModel : unsigned char {
  kInertial,          // 21 INS error states, driven by the IMU
  kConstantVelocity,  // position and velocity, driven by acceleration noise (GNSS only)
};

struct ClockModel {
  // Random walks of the receiver oscillator, common to all time bases, and of each base against it.
  double offset_noise = 1.0;                // m/sqrt(s)
  double drift_noise = 0.5;                 // m/s/sqrt(s)
  double inter_system_noise = 0.01;         // m/sqrt(s)
  double inter_system_drift_noise = 0.001;  // m/s/sqrt(s)
};

struct EkfConfig {
  // Constant-velocity model: white acceleration, 1 sigma spectral density in (m/s^2)/sqrt(Hz).
  double acceleration_noise_horizontal = 1.0;
  double acceleration_noise_vertical = 0.3;
  ClockModel clock;
  RobustConfig robust;
  // All of the first `k` epochs' innovations beyond this many sigma point to a wrong prediction,
  // not to outliers: the filter widens its covariance instead of rejecting them all.
  double reset_ratio =
      0.7;               // share of code measurements rejected in one epoch that counts as suspect
  int reset_epochs = 3;  // suspect epochs in a row before the filter restarts from a point solution
};

}  // namespace leonav
