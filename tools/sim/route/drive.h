// This unit computes the vehicle's true motion.
#pragma once
#include "tools/sim/motion/spline_motion.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Returns the motion along the route's file or its waypoints, or a random drive or flight from the
// scenario's seed. A file's motion begins at the scenario's start. Throws std::runtime_error for
// waypoints or a file that give no route.
SplineMotion drive(const Scenario& scenario);

}  // namespace leonav::sim
