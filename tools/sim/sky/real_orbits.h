// This unit reads the orbits of real satellites from RINEX navigation and SP3 files.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/gnss/signals/satellite.h"
#include "tools/sim/sky/group_delays.h"
#include "tools/sim/sky/orbit_table.h"

namespace leonav::sim {

// One real satellite.
struct RealOrbit {
  SatelliteId satellite;
  OrbitTable orbit;
  std::uint16_t health = 0;
  std::optional<BroadcastDelays> group_delay_m;  // where the file gives it
};

// The time for which orbits are needed.
struct OrbitSpan {
  GpsTime start;           // of the scenario
  double first_s, last_s;  // s from the start
};

// Returns every satellite of the system that has an orbit in the file at `span.start`.
//
// SP3: the polynomial through its nodes. RINEX: the elements of two neighbouring reference times
// blend into each other between them (smooth to the acceleration), and hold for two hours beyond
// the first and last. Where the file ends, a satellite continues under the gravity of Earth, Sun
// and Moon. Throws FileError for a file that cannot be read or has no satellite of the system at
// the start.
std::vector<RealOrbit> load_real_orbits(const std::string& path, System system,
                                        const OrbitSpan& span);

}  // namespace leonav::sim
