#include "tools/sim/scenario/route_config.h"

#include <numbers>

namespace leonav::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

void read_waypoint(ConfigReader& group, RouteConfig* route) {
  Waypoint w;
  constexpr Bounds kPlace = {-1e5, 1e5};
  double up_m = 0.0;
  group.number("north_m", kPlace, &w.p_n.x());
  group.number("east_m", kPlace, &w.p_n.y());
  group.number("up_m", {-1e3, 1e4}, &up_m);
  w.p_n.z() = -up_m;
  group.number("speed_m_s", {0.5, 300.0}, &w.speed_m_s);
  group.number("stop_s", {0.0, 1e5}, &w.stop_s);
  route->waypoints.push_back(w);
}

void read_track(ConfigReader& group, RouteConfig* route) {
  std::string file;
  group.text("file", &file);
  if (file.empty()) return;
  if (!route->waypoints.empty()) group.fail("file", "and waypoints exclude each other");
  try {
    set_track(file, route);
  } catch (const FileError& error) {
    group.fail("file", error.what());
  }
}

}  // namespace

void set_track(const std::string& file, RouteConfig* route) {
  route->track = read_truth_csv(file).points;
  route->origin = route->track.front().position;
  route->file = file;
}

void read_route(ConfigReader& group, RouteConfig* route) {
  group.choice<VehicleKind>("vehicle", {{"car", VehicleKind::kCar}, {"uav", VehicleKind::kUav}},
                            &route->vehicle);
  group.number("origin_latitude_deg", {-90.0, 90.0}, &route->origin.latitude, kDegree);
  group.number("origin_longitude_deg", {-180.0, 180.0}, &route->origin.longitude, kDegree);
  group.number("origin_height_m", {-1e3, 1e4}, &route->origin.height);
  group.number("standing_s", {0.0, 1e5}, &route->standing_s);
  group.number("block_m", {50.0, 5000.0}, &route->block_m);
  group.number("hill_m", {0.0, 500.0}, &route->hill_m);
  group.number("max_acceleration_m_s2", {0.1, 50.0}, &route->max_acceleration_m_s2);
  group.number("max_braking_m_s2", {0.1, 50.0}, &route->max_braking_m_s2);
  group.number("max_lateral_m_s2", {0.1, 50.0}, &route->max_lateral_m_s2);
  group.groups("waypoints", [&](ConfigReader& r) { read_waypoint(r, route); });
  if (route->waypoints.size() == 1) group.fail("waypoints", "one alone makes no road; give two");
  group.number("max_gap_s", {0.01, 60.0}, &route->max_gap_s);
  read_track(group, route);
}

}  // namespace leonav::sim
