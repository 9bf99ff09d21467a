#include "tools/sim/route/city_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace leonav::sim {
namespace {

double course_of(int heading) { return 0.5 * std::numbers::pi * heading; }

bool leads_out(const Eigen::Vector3d& p, int heading) {
  constexpr double kFar = 4000.0;  // m
  const double north = p.x() * std::cos(course_of(heading));
  const double east = p.y() * std::sin(course_of(heading));
  return std::max(north, east) > kFar;
}

}  // namespace

std::vector<Waypoint> city_drive(const RouteConfig& route, double duration_s,
                                 GaussianGenerator random) {
  constexpr double kStopShare = 1.0 / 3.0, kTurnShare = 0.5;
  const double wave = 2.0 * std::numbers::pi / (9.0 * route.block_m);
  const auto height = [&](const Eigen::Vector3d& p) {
    return route.hill_m * (std::sin(wave * p.x()) * std::cos(0.7 * wave * p.y()));
  };
  std::vector<Waypoint> waypoints(1);
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  int heading = 0;  // quarter turns from north
  double travelled_m = 0.0;
  const double needed_m = 17.0 * duration_s;  // more than can be driven
  while (travelled_m < needed_m) {
    Waypoint next;
    next.speed_m_s = 8.0 + 9.0 * random.uniform();
    const double stop = random.uniform(), turn = random.uniform(), side = random.uniform();
    const double length = route.block_m * (0.6 + 0.8 * random.uniform());
    if (stop < kStopShare) next.stop_s = 5.0 + 35.0 * stop / kStopShare;
    const double course = course_of(heading);
    p += length * Eigen::Vector3d(std::cos(course), std::sin(course), 0.0);
    next.p_n = p;
    next.p_n.z() = -height(p);
    waypoints.push_back(next);
    travelled_m += length;
    const int wanted = turn >= kTurnShare ? 0 : side < 0.5 ? 1 : -1;
    // The drive stays within this distance; otherwise a drive of hours would leave the tangent
    // plane. One of the three ways never leads out, and none of them back.
    for (const int quarter : {wanted, 0, 1, -1}) {
      if (leads_out(p, heading + quarter)) continue;
      heading += quarter;
      break;
    }
  }
  return waypoints;
}

}  // namespace leonav::sim
