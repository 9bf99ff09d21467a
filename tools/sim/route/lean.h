// This unit computes how a vehicle's body leans with its motion.
#pragma once
#include "tools/sim/scenario/route_config.h"

namespace leonav::sim {

// Motion along the path.
struct PathMotion {
  double speed_m_s = 0.0;     // over ground
  double lateral_m_s2 = 0.0;  // acceleration to the right
  double along_m_s2 = 0.0;    // acceleration forward
  double slope = 0.0;         // rad, positive uphill
};

// Lean of the body.
struct Lean {
  double roll = 0.0, pitch = 0.0;  // rad
};

// Returns the lean. A car follows the slope, and rolls outwards and pitches on its springs. A UAV
// (multicopter) banks into the turn, and noses down to accelerate and against the drag, regardless
// of the slope.
Lean lean_of(VehicleKind kind, const PathMotion& motion);

}  // namespace leonav::sim
