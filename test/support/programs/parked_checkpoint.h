// What a vehicle left that was parked.
#pragma once
#include "core/earth/ellipsoid.h"
#include "core/navigator/interface/checkpoint.h"

namespace leonav::test {

inline Checkpoint parked() {
  Checkpoint checkpoint;
  checkpoint.time = GpsTime::from_week_and_tow(2300, 345678.25);
  checkpoint.standing = true;
  checkpoint.antenna_p_e = to_ecef({0.69, 0.14, 300.0});
  checkpoint.antenna_sigma = 2.5;
  checkpoint.heading = -1.25;
  checkpoint.heading_sigma = 0.02;
  checkpoint.gyro_bias_b = {1e-4, -2e-4, 3e-4};
  checkpoint.gyro_bias_sigma = 5e-5;
  checkpoint.code_sigma_factor = 3.5;
  checkpoint.doppler_sigma_factor = 1.25;
  Calibration& calibration = checkpoint.calibration.emplace();
  calibration.mounting_rpy = {0.0, 0.0, 0.5};
  calibration.accel_bias_b = {0.02, -0.01, 0.03};
  calibration.accel_bias_sigma = {0.003, 0.004, 0.005};
  calibration.gyro_scale = {0.001, -0.002, 0.0005};
  calibration.gyro_scale_sigma = {0.0004, 0.0005, 0.0006};
  calibration.accel_scale = {-0.001, 0.002, 0.001};
  calibration.accel_scale_sigma = {0.0003, 0.0004, 0.0005};
  // The pitch of the direction of travel was not estimated.
  calibration.constants = {0.01, 0.0, -0.003, 0.55, 0.02, -1.1, 0.004};
  calibration.constant_sigmas = {0.01, 0.0, 0.004, 0.04, 0.04, 0.05, 0.002};
  return checkpoint;
}

}  // namespace leonav::test
