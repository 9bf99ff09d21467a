// OdometerConfig configures the simulated odometer, a wheel that counts pulses.
#pragma once
#include <Eigen/Core>

#include "daemon/config/config_reader.h"

namespace leonav::sim {

// Settings of the odometer.
struct OdometerConfig {
  double rate_hz = 0.0;  // 0: no odometer
  double latency_s = 0.01;
  double scale_error = 0.0;  // share by which it counts too much
  double resolution_m = 0.02;
  bool signed_pulses = true;            // false: it does not distinguish reverse
  double slip_per_acceleration = 0.0;   // the wheel turns faster by this share, 1/(m/s^2)
  double lock_braking_m_s2 = 1000.0;    // braking harder stops the wheel
  Eigen::Vector3d point_b = {0, 0, 0};  // m from the IMU: the point whose distance it counts
};

void read_odometer(ConfigReader& group, OdometerConfig* odometer);

}  // namespace leonav::sim
