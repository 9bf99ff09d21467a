// These functions read the messages that leonavd publishes, as hostile as its inputs are.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/gnss/measurement/measurement.h"
#include "core/gnss/signals/satellite.h"
#include "core/navigator/interface/input_fault.h"
#include "core/navigator/interface/solution.h"

namespace leonav {

// One satellite of EPOCH. Not finite: unknown.
struct OutputSatellite {
  SatelliteId satellite;
  Reason reason = Reason::kUsed;
  double elevation = 0.0, azimuth = 0.0;  // rad
  double cn0_dbhz = 0.0;
};

// What others need of EPOCH.
struct EpochInView {
  GpsTime time;
  int satellites_used = 0;
  double pdop = 0.0, hdop = 0.0, vdop = 0.0;  // not finite: unknown
  std::vector<OutputSatellite> satellites;    // a satellite that is unknown is left out
};

// Reads SOLUTION of the newest schema; fills `solution` only where it returns kNone. Position,
// velocity, attitude and sigmas must be finite and in range; IMU errors are not read.
InputFault decode_output(std::span<const std::uint8_t> bytes, Solution* solution);
// Reads EPOCH of the newest schema.
InputFault decode_output(std::span<const std::uint8_t> bytes, EpochInView* epoch);

}  // namespace leonav
