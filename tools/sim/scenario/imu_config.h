// The inertial sensor.
#pragma once

#include "core/ins/imu_error_model.h"
#include "daemon/config/config_reader.h"

namespace leonav::sim {

struct ImuConfig {
  bool enabled = true;
  bool ideal = false;  // without any error
  double rate_hz = 200.0;
  ImuErrorModel errors;
};

void read_sensor(ConfigReader& group, ImuConfig* imu);

}  // namespace leonav::sim
