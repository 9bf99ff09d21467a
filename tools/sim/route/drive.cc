#include "tools/sim/route/drive.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/earth/rotation.h"
#include "tools/sim/route/city_grid.h"
#include "tools/sim/route/lean.h"
#include "tools/sim/route/recorded_track.h"
#include "tools/sim/route/road.h"
#include "tools/sim/route/speed_profile.h"
#include "tools/sim/route/uav_flight.h"
#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {
namespace {

constexpr double kRounding = 18.0;  // m
constexpr double kTail = 2.0;       // s: at its ends a natural spline has no true acceleration

std::vector<Waypoint> waypoints_of(const Scenario& scenario) {
  const RouteConfig& route = scenario.route;
  if (!route.waypoints.empty()) return route.waypoints;
  const GaussianGenerator random = random_stream(scenario.seed, "route");
  return route.vehicle == VehicleKind::kUav ? uav_flight(route, scenario.duration_s, random)
                                            : city_drive(route, scenario.duration_s, random);
}

EulerAngles attitude(VehicleKind kind, const RoadPlace& place, double speed, double acceleration) {
  const Lean lean =
      lean_of(kind, {speed, speed * speed * place.curvature, acceleration, place.slope});
  return {lean.roll, lean.pitch, place.course};
}

SplineMotion along_road(const Scenario& scenario) {
  const RouteConfig& route = scenario.route;
  const std::vector<Waypoint> waypoints = waypoints_of(scenario);
  const Road road(waypoints, kRounding);
  const std::vector<double> s = drive_along(road, route, waypoints, scenario.duration_s + kTail);

  std::vector<double> times;
  for (std::size_t i = 0; i < s.size(); ++i) times.push_back(kDriveStep * static_cast<double>(i));
  const SmoothingSpline along(times, s, 0.0);
  std::array<std::vector<double>, 3> position, angles;
  MotionSplines splines;
  splines.origin_e = to_ecef(route.origin);
  const Eigen::Matrix3d C_en = rotation_ecef_to_ned(route.origin).transpose();
  for (const double t : times) {
    const auto now = along.evaluate(t);
    const RoadPlace place = road.at(now.value);
    const Eigen::Vector3d p = C_en * place.p_n;
    const EulerAngles a = attitude(route.vehicle, place, now.first, now.second);
    const std::array<double, 3> rpy{a.roll, a.pitch, a.yaw};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis].push_back(p[static_cast<Eigen::Index>(axis)]);
      angles[axis].push_back(rpy[axis]);
    }
  }
  splines.start = scenario.start;
  splines.duration_s = scenario.duration_s;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    splines.position[axis] = SmoothingSpline(times, position[axis], 0.0);
    splines.attitude[axis] = SmoothingSpline(times, angles[axis], 0.0);
  }
  return SplineMotion(std::move(splines));
}

// Returns why a file is not a route, and what was left out of it.
std::string why_not(const RouteConfig& route, const std::string& what) {
  const std::string missing = left_out(route.file_report);
  return route.file + ": " + what + (missing.empty() ? "" : "; " + missing);
}

SplineMotion along_track(const RouteConfig& route) {
  try {
    return recorded_track(route);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(why_not(route, error.what()));
  }
}

}  // namespace

SplineMotion drive(const Scenario& scenario) {
  if (scenario.route.track.empty()) return along_road(scenario);
  MotionSplines splines = along_track(scenario.route).splines();
  splines.start = scenario.start;
  splines.duration_s = std::min(splines.duration_s, scenario.duration_s);
  return SplineMotion(std::move(splines));
}

}  // namespace leonav::sim
