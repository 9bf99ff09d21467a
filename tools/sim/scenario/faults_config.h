// Fault describes one scripted fault of a scenario: what happens, when and to which satellites.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "core/gnss/signals/satellite.h"
#include "daemon/config/config_reader.h"

namespace leonav::sim {

// Kinds of faults.
enum class FaultKind {
  kOutage,          // satellites are not received
  kSatelliteClock,  // clocks differ from the products: jump_m, then drift_m_s
  kBadOrbit,        // provided orbits are wrong by along_m, cross_m, radial_m
  kSpoofing,        // signals are pulled off at up to pull_m_s
  kImuGap,          // no IMU samples
  kImuSaturation,   // IMU samples stop at gyro_limit, accel_limit
  kLate,            // messages of `stream` arrive delay_s later
  kDuplicate,       // messages of `stream` arrive twice
  kReceiverReset,   // the receiver is off, then starts anew
};
enum class Stream { kImu, kGnss, kProducts, kOdometer };

// One fault, in SI units.
struct Fault {
  FaultKind kind = FaultKind::kOutage;
  double from_s = 0.0, to_s = std::numeric_limits<double>::infinity();  // [from, to)
  // The satellites concerned; if none is named, all.
  std::vector<System> systems;
  std::vector<SatelliteId> satellites;
  double below_elevation = 2.0;  // rad; an outage spares satellites above; 2: none
  double jump_m = 0.0, drift_m_s = 0.0;
  double along_m = 0.0, cross_m = 0.0, radial_m = 0.0;
  double pull_m_s = 1.0, pull_time_s = 20.0;   // rate, and the time until it is reached
  double gyro_limit = 1e9, accel_limit = 1e9;  // rad/s, m/s^2
  Stream stream = Stream::kGnss;
  double delay_s = 1.0;
  std::string where;  // in the scenario, for errors
};

// Reads one element of the list "faults".
void read_fault(ConfigReader& group, std::vector<Fault>* faults);

}  // namespace leonav::sim
