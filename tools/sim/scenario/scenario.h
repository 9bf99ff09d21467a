// Scenario holds the contents of a scenario file.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/gps_time.h"
#include "tools/sim/scenario/atmosphere_config.h"
#include "tools/sim/scenario/constellation_config.h"
#include "tools/sim/scenario/faults_config.h"
#include "tools/sim/scenario/imu_config.h"
#include "tools/sim/scenario/odometer_config.h"
#include "tools/sim/scenario/places_config.h"
#include "tools/sim/scenario/receiver_config.h"
#include "tools/sim/scenario/route_config.h"
#include "tools/sim/scenario/street_errors_config.h"

namespace leonav::sim {

// All settings of a simulated run.
struct Scenario {
  std::string name;
  std::uint64_t seed = 1;
  GpsTime start;
  double duration_s = 600.0;
  double truth_interval_s = 0.0;  // of truth.csv; 0: the receiver's
  RouteConfig route;
  ImuConfig imu;
  OdometerConfig odometer;
  std::array<ConstellationConfig, kSystemCount> constellations;  // by System
  ReceiverConfig receiver;
  AtmosphereConfig atmosphere;
  PlacesConfig places;
  StreetErrorsConfig street_errors;
  std::vector<Fault> faults;
  bool ideal = false;              // everything that a navigator cannot model is removed
  std::vector<std::string> given;  // the keys that were given

  // Carriers; of LEO satellites those of their constellation.
  const BandPlan& bands() const { return constellations[index_of(System::kLeo)].bands; }
};

}  // namespace leonav::sim
