// How fast a vehicle goes along its road.
#pragma once
#include <vector>

#include "tools/sim/route/road.h"

namespace leonav::sim {

// Length along the road every kDriveStep seconds from the start on, `duration_s` long: standing
// first, within the waypoints' speed limits, the route's accelerations and what the bends allow,
// standing at waypoints that say so for exactly so long, and at the end of the road. Smooth:
// acceleration changes within a second.
std::vector<double> drive_along(const Road& road, const RouteConfig& route,
                                const std::vector<Waypoint>& waypoints, double duration_s);

inline constexpr double kDriveStep = 0.05;  // s

}  // namespace leonav::sim
