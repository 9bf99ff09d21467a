// Track holds the rows of a solution file or of a truth file.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/base/gps_time.h"
#include "core/earth/ellipsoid.h"

namespace leonav {

// What the errors of a row do not exceed, as the solution states it.
struct StatedLevels {
  std::optional<double> horizontal_m, vertical_m, heading;  // m, m, rad
};

// One row.
struct TrackPoint {
  GpsTime time;
  Geodetic position;
  std::optional<Eigen::Vector3d> v_n;        // m/s, north east down
  std::array<std::optional<double>, 3> rpy;  // rad: roll, pitch, yaw
  std::optional<Eigen::Vector3d> sigma_neu;  // m, 1 sigma
  std::optional<double> sigma_yaw;           // rad
  StatedLevels levels;
};

using Track = std::vector<TrackPoint>;  // times strictly increasing

// Rows that are not in the track. They may have been every other epoch; then the interval of the
// remaining ones, and the availability that follows from it, are meaningless.
struct SkippedRows {
  long skipped = 0, rows = 0;  // rows: those used
  std::string first_problem;   // FILE:LINE: what
};

// Reads truth.csv, or RTKLIB's .pos, recognized by content. Throws FileError.
Track load_truth(const std::string& path, SkippedRows* skipped = nullptr);

// Returns a point from "LATITUDE,LONGITUDE,HEIGHT" (degrees, m above the ellipsoid), at rest.
// Throws UsageError.
TrackPoint surveyed_point(const std::string& text);

// Returns the truth of a point that stands, over the time of a solution.
Track standing_at(const TrackPoint& point, const Track& solution);

// Reads solution.csv or RTKLIB's .pos (latitude, longitude, height or x, y, z), recognized by
// content. Throws FileError, also if no row is usable.
Track load_solution(const std::string& path, SkippedRows* skipped = nullptr);

// Returns one line for people; empty if nothing was skipped.
std::string to_string(const SkippedRows& skipped);

}  // namespace leonav
