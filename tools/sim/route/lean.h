// How a vehicle's body leans with its motion.
#pragma once
#include "tools/sim/scenario/route_config.h"

namespace leonav::sim {

struct PathMotion {
  double speed_m_s = 0.0;     // over ground
  double lateral_m_s2 = 0.0;  // acceleration to the right
  double along_m_s2 = 0.0;    // and forward
  double slope = 0.0;         // rad, positive uphill
};

struct Lean {
  double roll = 0.0, pitch = 0.0;  // rad
};

// A car lies on the slope and rolls outwards and back on its springs. A UAV (multicopter) banks
// into the turn, and noses down to speed up and against the drag; its body ignores the slope.
Lean lean_of(VehicleKind kind, const PathMotion& motion);

}  // namespace leonav::sim
