// Solutions as RTKLIB writes them (.pos), so that its results can be judged by the same tool.
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "core/time/gps_time.h"

namespace leonav {

struct PosRow {
  GpsTime time;
  Geodetic position;  // of the antenna; ellipsoidal height
  int quality = 0;    // 1 fixed, 2 float, 4 DGPS, 5 single, 6 PPP
  int satellites = 0;
  Eigen::Vector3d sigma_neu =
      Eigen::Vector3d::Zero();  // m; zero where the file has none (x, y, z form)
};

struct PosFile {
  std::vector<PosRow> rows;
  long skipped = 0;  // lines that are no solution, or whose time does not fit those around them
  long first_skipped_line = 0;
};

// True if the file begins like one of RTKLIB's.
bool looks_like_pos(const std::string& path);

// Times in GPS time as week and seconds or as date; positions as degrees and height or ECEF.
// Throws FileError if the file is absent or has no solution.
PosFile read_pos(const std::string& path);

}  // namespace leonav
