// A random flight of a multicopter.
#pragma once
#include <vector>

#include "tools/motion/gaussian_generator.h"
#include "tools/sim/scenario/route_config.h"

namespace leonav::sim {

// Enough waypoints for `duration_s`: climbs away from the ground, then legs of one to three blocks
// at 40 to 120 m and 6 to 16 m/s, turning by up to 120 degrees; it hovers at a quarter of them.
std::vector<Waypoint> uav_flight(const RouteConfig& route, double duration_s,
                                 GaussianGenerator random);

}  // namespace leonav::sim
