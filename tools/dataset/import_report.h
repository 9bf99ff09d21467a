// What an import used, left out and lacks.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/satellite.h"
#include "core/time/gps_time.h"

namespace leonav {

struct ImportReport {
  struct Skip {
    std::string where;  // FILE or FILE:LINE of the first
    std::string reason;
    long count = 0;
  };

  long epochs = 0, imu_samples = 0, ephemerides = 0, orbit_epochs = 0, clock_epochs = 0,
       ionosphere_models = 0;
  long odometer_increments = 0;
  long satellite_antennas = 0;
  std::string receiver_antenna;       // whose model is used; empty: none
  std::map<System, long> satellites;  // different ones observed
  GpsTime first, last;                // of epochs and IMU samples
  std::vector<Skip> skipped;
  std::vector<std::string> warnings;  // what the recording lacks, and what will be worse for it

  void skip(std::string_view where, std::string_view reason, long count);
  // A stream of which more than half is not used is no longer the recording it seems to be.
  void warn_if_most_lost(const std::string& path, const std::string& what, long lost, long all);
};

// As text of several lines.
std::string to_string(const ImportReport& report);

}  // namespace leonav
