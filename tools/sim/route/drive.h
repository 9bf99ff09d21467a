// The vehicle's true motion.
#pragma once
#include "tools/motion/spline_motion.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Along the route's file or its waypoints, or a random drive or flight of the scenario's seed. A
// file's motion begins at the scenario's start. Throws std::runtime_error for waypoints or a file
// that make no route.
SplineMotion drive(const Scenario& scenario);

}  // namespace leonav::sim
