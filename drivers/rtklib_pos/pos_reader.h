// This unit reads solutions of RTKLIB (.pos), so that the same tool can evaluate them.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/gps_time.h"
#include "core/earth/ellipsoid.h"

namespace leonav {

// One solution.
struct PosRow {
  GpsTime time;
  Geodetic position;  // of the antenna; ellipsoidal height
  int quality = 0;    // 1 fixed, 2 float, 4 DGPS, 5 single, 6 PPP
  int satellites = 0;
  Eigen::Vector3d sigma_neu =
      Eigen::Vector3d::Zero();  // m; zero where the file has none (x, y, z form)
};

// All solutions of a file.
struct PosFile {
  std::vector<PosRow> rows;
  long skipped = 0;  // lines without a solution, or with a time out of order
  long first_skipped_line = 0;
};

// Returns whether the file begins like one of RTKLIB's.
bool looks_like_pos(const std::string& path);

// Reads a whole file. Times are in GPS time as week and seconds or as date; positions are degrees
// and height or ECEF. Throws FileError if the file is absent or has no solution.
PosFile read_pos(const std::string& path);

}  // namespace leonav
