// ImuConfig configures the simulated inertial sensor.
#pragma once

#include "core/inertial/strapdown/imu_error_model.h"
#include "daemon/config/config_reader.h"
#include "tools/sim/motion/inertial_sensor.h"

namespace leonav::sim {

enum class ImuGrade { kTactical, kMems, kIdeal };

// Settings of the sensor.
struct ImuConfig {
  bool enabled = true;
  bool ideal = false;  // without any error
  double rate_hz = 200.0;
  // Installation: rotation from the sensor's axes to the body's (rad), and how much later than
  // stamped it measures.
  Eigen::Vector3d mounting_rpy = Eigen::Vector3d::Zero();
  double time_offset_s = 0.0;
  ImuErrorModel errors;
  ImuImperfections imperfections;
};

// Returns the errors of a grade.
//
// kTactical is the papers' unit (POS320, Remote Sensing 2024, 16, 1782, table 1) and no more than
// that table gives; kMems is a consumer's sensor, as in the daemon's defaults; kIdeal has no
// errors.
ImuErrorModel errors_of(ImuGrade grade);

void read_sensor(ConfigReader& group, ImuConfig* imu);

}  // namespace leonav::sim
