// The inertial sensor.
#pragma once

#include "core/ins/imu_error_model.h"
#include "daemon/config/config_reader.h"
#include "tools/motion/inertial_sensor.h"

namespace leonav::sim {

enum class ImuGrade { kTactical, kMems, kIdeal };

struct ImuConfig {
  bool enabled = true;
  bool ideal = false;  // without any error
  double rate_hz = 200.0;
  // As built in and read out: its axes turn into the body's by so much (rad), and it has measured
  // so much later than stamped.
  Eigen::Vector3d mounting_rpy = Eigen::Vector3d::Zero();
  double time_offset_s = 0.0;
  ImuErrorModel errors;
  ImuImperfections imperfections;
};

// tactical: the papers' unit (POS320, Remote Sensing 2024, 16, 1782, table 1), and no more than
// that table says; mems: a consumer's sensor, as the daemon's defaults describe it; ideal: no
// errors.
ImuErrorModel errors_of(ImuGrade grade);

void read_sensor(ConfigReader& group, ImuConfig* imu);

}  // namespace leonav::sim
