// The receiver and its antenna.
#pragma once
#include <Eigen/Core>
#include <array>

#include "core/gnss/satellite.h"
#include "daemon/config/config_reader.h"

namespace leonav::sim {

struct NoiseConfig {
  double code_m = 0.3, carrier_m = 0.002, doppler_m_s = 0.03;  // one frequency, at zenith
};

struct ReceiverConfig {
  double interval_s = 1.0;
  Eigen::Vector3d lever_arm_b = {0.4, -0.2, -1.1};
  double elevation_mask = 0.0873;  // rad
  double clock_offset_s = 1e-5, clock_drift = 1e-8;
  double clock_drift_walk = 1e-10;  // per sqrt(s)
  std::array<NoiseConfig, kSystemCount> noise;
  double gnss_latency_s = 0.05;
};

void read_receiver(ConfigReader& group, ReceiverConfig* receiver);

}  // namespace leonav::sim
