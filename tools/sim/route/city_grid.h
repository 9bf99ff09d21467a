// This unit draws a random drive through a city of rectangular blocks.
#pragma once
#include <vector>

#include "tools/sim/motion/gaussian_generator.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Returns enough waypoints for `duration_s`. At every crossing the drive goes straight on or turns;
// at a third of the crossings it stops for 5 to 40 s; limits are 8 to 17 m/s, hills gentle.
std::vector<Waypoint> city_drive(const RouteConfig& route, double duration_s,
                                 GaussianGenerator random);

}  // namespace leonav::sim
