// This unit draws a random flight of a multicopter.
#pragma once
#include <vector>

#include "tools/sim/motion/gaussian_generator.h"
#include "tools/sim/scenario/route_config.h"

namespace leonav::sim {

// Returns enough waypoints for `duration_s`. The flight climbs, then has legs of one to three
// blocks at 40 to 120 m and 6 to 16 m/s, with turns of up to 120 degrees; it hovers at a quarter of
// the waypoints.
std::vector<Waypoint> uav_flight(const RouteConfig& route, double duration_s,
                                 GaussianGenerator random);

}  // namespace leonav::sim
