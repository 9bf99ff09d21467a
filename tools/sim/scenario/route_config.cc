#include "tools/sim/scenario/route_config.h"
#include "core/base/angle.h"

#include <cmath>
#include <utility>

namespace leonav::sim {
namespace {

void read_waypoint(ConfigReader& group, RouteConfig* route) {
  Waypoint w;
  constexpr Bounds kPlace = {-1e5, 1e5};
  double up_m = 0.0;
  group.number("north_m", kPlace, &w.p_n.x());
  group.number("east_m", kPlace, &w.p_n.y());
  group.number("up_m", {-1e3, 1e4}, &up_m);
  w.p_n.z() = -up_m;
  group.number("speed_m_s", {0.05, 300.0}, &w.speed_m_s);
  group.number("stop_s", {0.0, 1e5}, &w.stop_s);
  w.where = group.where("");
  route->waypoints.push_back(w);
}

void read_track(ConfigReader& group, const std::filesystem::path& folder, RouteConfig* route) {
  std::string file;
  group.text("file", &file);
  if (file.empty()) return;
  if (!route->waypoints.empty()) return group.report("file", "and waypoints exclude each other");
  try {
    set_track((folder / file).string(), route);
  } catch (const FileError& error) {
    group.report("file", error.what());
  }
}

// One wrong row would become a flight round the world, which the smoothing would make plausible.
void check_leaps(const std::string& file, const std::vector<TruthPoint>& points) {
  constexpr double kFastest_m_s = 500.0, kScatter_m = 10.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double dt = seconds_between(points[i].time, points[i - 1].time);
    const double leap = (to_ecef(points[i].position) - to_ecef(points[i - 1].position)).norm();
    if (leap <= kFastest_m_s * dt + kScatter_m) continue;
    throw FileError(file, 0,
                    "leaps by " + std::to_string(std::lround(leap)) + " m in " +
                        std::to_string(dt) + " s before time of week " +
                        std::to_string(points[i].time.tow_s()) +
                        ", faster than 500 m/s; mend or take out the rows there");
  }
}

}  // namespace

void set_track(const std::string& file, RouteConfig* route) {
  TruthCsv truth = read_truth_csv(file);
  check_leaps(file, truth.points);
  route->track = std::move(truth.points);
  route->file_report = std::move(truth.report);
  route->origin = route->track.front().position;
  route->file = file;
}

std::string left_out(const CsvReport& report) {
  if (report.skipped == 0) return "";
  const bool one = report.skipped == 1;
  std::string text =
      one ? "1 row was left out" : std::to_string(report.skipped) + " rows were left out";
  if (!report.problems.empty()) text += ": " + report.problems.front();
  if (!one && !report.problems.empty()) text += ", and others";
  return text;
}

void read_route(ConfigReader& group, const std::filesystem::path& folder, RouteConfig* route) {
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
  if (route->waypoints.size() == 1) group.report("waypoints", "one alone makes no road; give two");
  group.number("max_gap_s", {0.01, 60.0}, &route->max_gap_s);
  read_track(group, folder, route);
}

}  // namespace leonav::sim
