// Where every satellite of a scenario really is, and what its clock really says.
#pragma once
#include <vector>

#include "core/gnss/satellite.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/sky/clock_table.h"
#include "tools/sim/sky/orbit_table.h"

namespace leonav::sim {

struct TrueSatellite {
  SatelliteId id;
  std::size_t constellation = 0;  // of the scenario's
  OrbitTable orbit;               // of the centre of mass
  ClockTable clock;               // without the periodic relativistic term
};

struct TrueSky {
  std::vector<TrueSatellite> satellites;  // in order of id
};

// Orbits are there from `kSkyMargin_s` before the start to as long after the end: products need
// nodes on both sides.
TrueSky build_sky(const Scenario& scenario);
inline constexpr double kSkyMargin_s = 9.0 * 900.0;

// Clock minus system time with the relativistic term of the orbit, s.
double clock_s(const TrueSatellite& satellite, double t);

// Inertial axes (those of ECEF at the start) to ECEF at `t`.
Eigen::Vector3d to_earth(const Eigen::Vector3d& p_i, double t);
Eigen::Vector3d to_inertial(const Eigen::Vector3d& p_e, double t);

}  // namespace leonav::sim
