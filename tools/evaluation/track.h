// A track to be judged, or to judge by: a solution file or a truth file as plain rows.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "core/time/gps_time.h"

namespace leonav {

struct TrackPoint {
  GpsTime time;
  Geodetic position;
  std::optional<Eigen::Vector3d> v_n;        // m/s, north east down
  std::array<std::optional<double>, 3> rpy;  // rad: roll, pitch, yaw
  std::optional<Eigen::Vector3d> sigma_neu;  // m, 1 sigma
};

using Track = std::vector<TrackPoint>;  // times strictly increasing

// What of a file is not in the track. It may have been every other epoch: then the interval of
// those left, and the availability that follows from it, tell nothing.
struct SkippedRows {
  long skipped = 0, rows = 0;  // rows: those used
  std::string first_problem;   // FILE:LINE: what
};

// truth.csv. Throws FileError.
Track load_truth(const std::string& path, SkippedRows* skipped = nullptr);

// solution.csv, or RTKLIB's .pos (latitude, longitude, height or x, y, z), told apart by content.
// Throws FileError, also where no row is usable.
Track load_solution(const std::string& path, SkippedRows* skipped = nullptr);

// A line for people; empty: nothing was skipped.
std::string to_string(const SkippedRows& skipped);

}  // namespace leonav
