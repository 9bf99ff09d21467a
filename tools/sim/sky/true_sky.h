// TrueSky holds the true orbit and the true clock of every satellite of a scenario.
#pragma once
#include <vector>

#include "core/gnss/signals/satellite.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/sky/clock_table.h"
#include "tools/sim/sky/group_delays.h"
#include "tools/sim/sky/orbit_table.h"

namespace leonav::sim {

// One satellite.
struct TrueSatellite {
  SatelliteId id;
  std::size_t constellation = 0;  // index among the scenario's
  OrbitTable orbit;               // of the centre of mass
  ClockTable clock;               // without the periodic relativistic term
  BroadcastDelays group_delay_m = {0.0, 0.0};
  std::uint16_t health = 0;  // as broadcast; 0: healthy
};

// All satellites.
struct TrueSky {
  std::vector<TrueSatellite> satellites;  // in order of id
};

// Builds the sky. Throws FileError for a file of real satellites that cannot be read or has none at
// the start.
TrueSky build_sky(const Scenario& scenario);

// Returns for how long before the start and after the end orbits and clocks exist: products need
// nodes on both sides, broadcast elements arcs around their reference times.
double sky_margin_s(const ConstellationConfig& constellation);

// Returns clock minus system time with the relativistic term of the orbit, s.
double clock_s(const TrueSatellite& satellite, double t);

// These convert between inertial axes (those of ECEF at the start) and ECEF at `t`.
Eigen::Vector3d to_earth(const Eigen::Vector3d& p_i, double t);
Eigen::Vector3d to_inertial(const Eigen::Vector3d& p_e, double t);

}  // namespace leonav::sim
