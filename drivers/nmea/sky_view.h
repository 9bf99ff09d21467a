// SkyView is what the sentences tell of satellites: those of one epoch.
#pragma once
#include <limits>
#include <vector>

#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

struct SatelliteView {
  SatelliteId satellite;
  double elevation = 0.0, azimuth = 0.0;  // rad; NaN: not known
  double cn0_dbhz = 0.0;                  // 0: not known
  bool is_used = false;
};

struct SkyView {
  GpsTime time;
  int used = 0;  // satellites in the solution
  double pdop = std::numeric_limits<double>::quiet_NaN();
  double hdop = std::numeric_limits<double>::quiet_NaN();
  double vdop = std::numeric_limits<double>::quiet_NaN();
  std::vector<SatelliteView> satellites;
};

}  // namespace leonav
