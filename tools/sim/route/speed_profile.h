// This unit computes the speed of a vehicle along its road.
#pragma once
#include <vector>

#include "tools/sim/route/road.h"

namespace leonav::sim {

// Returns the length along the road every kDriveStep seconds from the start, for `duration_s`.
//
// The vehicle stands first, keeps the waypoints' speed limits, the route's accelerations and the
// limits of the bends, and stands at waypoints with a stop for exactly that time, and at the end of
// the road. The acceleration changes smoothly, within a second.
std::vector<double> drive_along(const Road& road, const RouteConfig& route,
                                const std::vector<Waypoint>& waypoints, double duration_s);

inline constexpr double kDriveStep = 0.05;  // s

}  // namespace leonav::sim
