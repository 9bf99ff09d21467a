// The navigator's configuration for synthetic drives.
#pragma once
#include "core/navigator/interface/navigator_config.h"
#include "support/drive/synthetic_drive.h"
#include "support/drive/white_errors.h"

namespace leonav::test {

// All systems on, the drive's lever arm, an IMU of good tactical grade, errors of measurements
// white as in the drive; else the defaults.
inline NavigatorConfig drive_navigator_config(const SyntheticDriveOptions& options,
                                              MotionModel motion = MotionModel::kInertial) {
  NavigatorConfig config;
  config.motion = motion;
  config.ekf = white_error_config();
  config.gnss = default_gnss_config();
  for (SystemConfig& system : config.gnss.systems) system.enabled = true;
  config.vehicle.lever_arm_b = options.lever_arm_b;
  config.imu.angle_random_walk = 1e-4;
  config.imu.velocity_random_walk = 1e-3;
  config.imu.gyro_bias = {1e-4, 3600.0};
  config.imu.accel_bias = {0.01, 3600.0};
  config.imu.gyro_scale = {1e-4, 3600.0};
  config.imu.accel_scale = {1e-4, 3600.0};
  return config;
}

inline NavigatorConfig config_with_carriers(const SyntheticDrive& drive) {
  NavigatorConfig config = drive_navigator_config(drive.options);
  config.ekf.use_carrier = true;
  return config;
}

}  // namespace leonav::test
