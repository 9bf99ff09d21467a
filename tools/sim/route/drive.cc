#include "tools/sim/route/drive.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/earth/rotation.h"
#include "tools/sim/route/city_grid.h"
#include "tools/sim/route/road.h"
#include "tools/sim/route/speed_profile.h"
#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {
namespace {

constexpr double kGravity = 9.81;
// A passenger car's springs: some 5 degrees of roll and 2.5 of pitch at 1 g.
constexpr double kRollPerAcceleration = 0.009, kPitchPerAcceleration = 0.0045;  // rad/(m/s^2)
constexpr double kRounding = 18.0;                                              // m

EulerAngles attitude(VehicleKind kind, const RoadPlace& place, double speed, double acceleration) {
  const double lateral = speed * speed * place.curvature;  // to the right
  EulerAngles angles;
  angles.yaw = place.course;
  if (kind == VehicleKind::kCar) {
    angles.roll = -kRollPerAcceleration * lateral;
    angles.pitch = place.slope + kPitchPerAcceleration * acceleration;
  } else {
    angles.roll = std::atan2(lateral, kGravity);
    angles.pitch = -std::atan2(acceleration, kGravity);
  }
  return angles;
}

}  // namespace

SplineMotion drive(const Scenario& scenario) {
  const RouteConfig& route = scenario.route;
  const std::vector<Waypoint> waypoints =
      route.waypoints.empty()
          ? city_drive(route, scenario.duration_s, random_stream(scenario.seed, "route"))
          : route.waypoints;
  const Road road(waypoints, kRounding);
  const std::vector<double> s = drive_along(road, route, waypoints, scenario.duration_s);

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
  splines.duration_s = times.back();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    splines.position[axis] = SmoothingSpline(times, position[axis], 0.0);
    splines.attitude[axis] = SmoothingSpline(times, angles[axis], 0.0);
  }
  return SplineMotion(std::move(splines));
}

}  // namespace leonav::sim
