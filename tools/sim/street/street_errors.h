// StreetErrors gives what a street does to the signals of one satellite, by statistics instead of
// houses.
#pragma once
#include <array>
#include <memory>

#include "core/gnss/signals/satellite.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/street/cycle_slip.h"

namespace leonav::sim {

// The satellite as the antenna sees it at one instant.
struct SatelliteSight {
  double t = 0.0;          // s from the start
  double elevation = 0.0;  // rad
  double turn = 0.0;       // of the direction, rad/s
};

// Errors of one signal, m and m/s.
struct StreetSignalError {
  double code_m = 0.0, carrier_m = 0.0, doppler_m_s = 0.0;
  // Factors of the receiver's noise; 0 where it is in the error already.
  double code_noise = 1.0, carrier_noise = 1.0, doppler_noise = 1.0;
};

// What happens to the satellite's signals at that instant.
struct StreetEffect {
  bool possible = true;                   // false: nothing is received
  double loss_db = 0.0;                   // of C/N0
  double extra_m = 0.0, extra_m_s = 0.0;  // longer way of a reflection that arrives alone
  unsigned route = 0;                     // another one breaks the carrier
  std::array<StreetSignalError, kTrackedSignals> signals;
  std::array<CycleSlip, kTrackedSignals> slips;  // since the call before
};

// StreetErrors is asked at instants in order of time, also while the satellite is not received.
class StreetErrors {
 public:
  virtual ~StreetErrors() = default;
  virtual StreetEffect at(const SatelliteSight& sight) = 0;
};

// Returns the errors of the scenario's family; nullptr for rays, whose errors come from places.
std::unique_ptr<StreetErrors> make_street_errors(const Scenario& scenario, SatelliteId satellite);

}  // namespace leonav::sim
