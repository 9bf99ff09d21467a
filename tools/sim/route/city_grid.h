// A random drive through a city of rectangular blocks.
#pragma once
#include <vector>

#include "tools/motion/gaussian_generator.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Enough waypoints for `duration_s`: straight on or round the corner at every crossing, a third of
// the crossings with a stop of 5 to 40 s, limits of 8 to 17 m/s, gentle hills.
std::vector<Waypoint> city_drive(const RouteConfig& route, double duration_s,
                                 GaussianGenerator random);

}  // namespace leonav::sim
