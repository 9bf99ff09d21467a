// Where every satellite of a scenario really is, and what its clock really says.
#pragma once
#include <vector>

#include "core/gnss/satellite.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/sky/clock_table.h"
#include "tools/sim/sky/group_delays.h"
#include "tools/sim/sky/orbit_table.h"

namespace leonav::sim {

struct TrueSatellite {
  SatelliteId id;
  std::size_t constellation = 0;  // of the scenario's
  OrbitTable orbit;               // of the centre of mass
  ClockTable clock;               // without the periodic relativistic term
  BroadcastDelays group_delay_m = {0.0, 0.0};
  std::uint16_t health = 0;  // as it broadcasts it; 0: healthy
};

struct TrueSky {
  std::vector<TrueSatellite> satellites;  // in order of id
};

// Throws FileError for a file of real satellites that cannot be read or has none at the start.
TrueSky build_sky(const Scenario& scenario);

// So long before the start and after the end orbits and clocks are there: products need nodes on
// both sides, broadcast elements arcs around their reference times.
double sky_margin_s(const ConstellationConfig& constellation);

// Clock minus system time with the relativistic term of the orbit, s.
double clock_s(const TrueSatellite& satellite, double t);

// Inertial axes (those of ECEF at the start) to ECEF at `t`.
Eigen::Vector3d to_earth(const Eigen::Vector3d& p_i, double t);
Eigen::Vector3d to_inertial(const Eigen::Vector3d& p_e, double t);

}  // namespace leonav::sim
