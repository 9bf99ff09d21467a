// The vehicle's true motion.
#pragma once
#include "tools/motion/spline_motion.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Along the route's waypoints, or a random drive of the scenario's seed. The body points along the
// road, leans with the accelerations (a car outwards and back on its springs, a UAV into the turn)
// and follows the slope. Throws std::runtime_error for waypoints that make no road.
SplineMotion drive(const Scenario& scenario);

}  // namespace leonav::sim
