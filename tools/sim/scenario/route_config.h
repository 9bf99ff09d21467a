// Where and how the vehicle goes.
#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "daemon/config/config_reader.h"
#include "drivers/csv/truth_csv.h"

namespace leonav::sim {

struct Waypoint {
  Eigen::Vector3d p_n = Eigen::Vector3d::Zero();  // from the origin, tangent plane, m
  double speed_m_s = 13.9;                        // limit from here on
  double stop_s = 0.0;                            // stands here for so long
  std::string where;                              // in the scenario, for errors; empty: drawn
};

enum class VehicleKind { kCar, kUav };

struct RouteConfig {
  VehicleKind vehicle = VehicleKind::kCar;
  Geodetic origin = {0.6965, 2.0322, 50.0};
  double standing_s = 60.0;         // before it sets off
  std::vector<TruthPoint> track;    // of a recorded drive; empty: none
  std::string file;                 // which it was read from
  CsvReport file_report;            // and what of it was left out
  double max_gap_s = 2.0;           // a wider hole in it is an error
  std::vector<Waypoint> waypoints;  // empty: a random drive through a city's grid of streets
  double block_m = 250.0;           // of that grid
  double hill_m = 10.0;             // its rise and fall
  double max_acceleration_m_s2 = 1.5, max_braking_m_s2 = 2.0, max_lateral_m_s2 = 2.5;
};

// Follows the recorded drive of `file` from its first point on. Throws FileError, also where it
// leaps farther than a vehicle goes.
void set_track(const std::string& file, RouteConfig* route);

// What of a file was left out, as "N rows were left out: FILE:LINE: why"; empty: nothing.
std::string left_out(const CsvReport& report);

// Reads route.file too, which is relative to `folder`.
void read_route(ConfigReader& group, const std::filesystem::path& folder, RouteConfig* route);

}  // namespace leonav::sim
