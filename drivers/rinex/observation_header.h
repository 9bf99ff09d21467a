// Header of a RINEX observation file, versions 2.00 to 3.05.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "core/gnss/signal.h"

namespace leonav {

enum class RinexTimeSystem : unsigned char {
  kGps,     // also Galileo, QZSS and NavIC time, which run with GPS time
  kBeidou,  // GPS minus 14 s
  kUtc,     // also GLONASS time as RINEX writes it: GPS minus leap seconds
};

// One column of the observation records.
struct ObservationType {
  char kind = 0;        // 'C' code, 'L' carrier, 'D' Doppler, 'S' strength; 0: column is not used
  SignalCode code;      // signal the value belongs to
  SignalCode fallback;  // RINEX 2: signal to take it if `code` has no pseudorange; else not set
  double scale = 1.0;   // the stored number is divided by it
};

struct ObservationHeader {
  int version_hundredths = 0;  // 211, 304, ...
  char file_system = 'G';      // 'M' for mixed
  RinexTimeSystem time_system = RinexTimeSystem::kGps;
  std::map<char, std::vector<ObservationType>>
      types;  // by system letter; RINEX 2: by 'G' and others
  Eigen::Vector3d approximate_p_e = Eigen::Vector3d::Zero();    // m, marker; zero: not given
  Eigen::Vector3d antenna_delta_hen = Eigen::Vector3d::Zero();  // m, height, east, north
  std::string marker, antenna;
  double interval_s = 0.0;  // 0: not given
};

}  // namespace leonav
