// RouteConfig describes the vehicle's route and its way of driving.
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "daemon/config/config_reader.h"
#include "drivers/csv/truth_csv.h"

namespace leonav::sim {

// One waypoint.
struct Waypoint {
  Eigen::Vector3d p_n = Eigen::Vector3d::Zero();  // from the origin, tangent plane, m
  double speed_m_s = 13.9;                        // limit from here on
  double stop_s = 0.0;                            // duration of a stop here
  std::string where;                              // line in the scenario, for errors; empty: drawn
};

enum class VehicleKind { kCar, kUav };

// Settings of the route.
struct RouteConfig {
  VehicleKind vehicle = VehicleKind::kCar;
  Geodetic origin = {0.6965, 2.0322, 50.0};
  double standing_s = 60.0;         // before it sets off
  std::vector<TruthPoint> track;    // of a recorded drive; empty: none
  std::string file;                 // file of the track
  CsvReport file_report;            // and the rows left out of it
  double max_gap_s = 2.0;           // a longer gap in it is an error
  std::vector<Waypoint> waypoints;  // empty: a random drive through a city's grid of streets
  double block_m = 250.0;           // of that grid
  double hill_m = 10.0;             // height of its hills
  double max_acceleration_m_s2 = 1.5, max_braking_m_s2 = 2.0, max_lateral_m_s2 = 2.5;
};

// Uses the recorded drive of `file` from its first point on. Throws FileError, also if it leaps
// farther than a vehicle can go.
void set_track(const std::string& file, RouteConfig* route);

// Returns what was left out of a file, as "N rows were left out: FILE:LINE: why"; empty: nothing.
std::string left_out(const CsvReport& report);

// Reads the group, including route.file, whose path is relative to `folder`.
void read_route(ConfigReader& group, const std::filesystem::path& folder, RouteConfig* route);

}  // namespace leonav::sim
