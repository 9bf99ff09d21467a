// The odometer: a wheel that counts pulses.
#pragma once
#include <Eigen/Core>

#include "daemon/config/config_reader.h"

namespace leonav::sim {

struct OdometerConfig {
  double rate_hz = 0.0;  // 0: there is none
  double latency_s = 0.01;
  double scale_error = 0.0;  // by which part it shows more than it should
  double resolution_m = 0.02;
  bool signed_pulses = true;            // false: it cannot tell reverse
  double slip_per_acceleration = 0.0;   // the wheel turns faster by this part, 1/(m/s^2)
  double lock_braking_m_s2 = 1000.0;    // braking harder stops the wheel
  Eigen::Vector3d point_b = {0, 0, 0};  // m from the IMU: whose way it counts
};

void read_odometer(ConfigReader& group, OdometerConfig* odometer);

}  // namespace leonav::sim
