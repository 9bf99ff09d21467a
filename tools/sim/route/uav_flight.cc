#include "tools/sim/route/uav_flight.h"
#include "core/base/angle.h"

#include <cmath>
#include <numbers>

namespace leonav::sim {

std::vector<Waypoint> uav_flight(const RouteConfig& route, double duration_s,
                                 GaussianGenerator random) {
  // m from the origin: farther out it turns home
  constexpr double kHoverShare = 0.25, kFar = 3000.0;
  std::vector<Waypoint> waypoints(1);
  waypoints[0].speed_m_s = 6.0;
  double course = 2.0 * std::numbers::pi * random.uniform(), travelled_m = 0.0;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  while (travelled_m < 17.0 * duration_s) {
    Waypoint next;
    const double length = route.block_m * (0.5 + random.uniform());
    const double turn = 240.0 * kDegree * (random.uniform() - 0.5);
    const double hover = random.uniform();
    const double up_m = 40.0 + 80.0 * random.uniform();
    next.speed_m_s = 6.0 + 10.0 * random.uniform();
    if (hover < kHoverShare) next.stop_s = 5.0 + 15.0 * hover / kHoverShare;
    p += length * Eigen::Vector3d(std::cos(course), std::sin(course), 0.0);
    // No leg climbs or descends by more than a third of its length.
    p.z() = std::clamp(-up_m, p.z() - length / 3.0, p.z() + length / 3.0);
    next.p_n = p;
    waypoints.push_back(next);
    travelled_m += length;
    course += turn;
    const Eigen::Vector2d heading(std::cos(course), std::sin(course));
    if (p.head<2>().norm() > kFar && p.head<2>().dot(heading) > 0.0) {
      // The smaller of the two turns that lead back is taken.
      course += (p.x() * heading.y() - p.y() * heading.x() > 0.0 ? 60.0 : -60.0) * kDegree - turn;
    }
  }
  return waypoints;
}

}  // namespace leonav::sim
