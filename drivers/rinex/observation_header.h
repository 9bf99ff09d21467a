// This unit parses the header of a RINEX observation file, versions 2.00 to 3.05.
#pragma once
#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/gps_time.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// Time system of the epochs of a file.
enum class RinexTimeSystem : unsigned char {
  kGps,     // also Galileo, QZSS and NavIC time, which run with GPS time
  kBeidou,  // GPS minus 14 s
  kUtc,     // also GLONASS time as RINEX writes it: GPS minus leap seconds
};

// Converts an instant that was read as if its calendar were GPS time to GPS time.
GpsTime to_gps_time(GpsTime as_written, RinexTimeSystem system);

// One column of the observation records.
struct ObservationType {
  char kind = 0;        // 'C' code, 'L' carrier, 'D' Doppler, 'S' strength; 0: column is not used
  SignalCode code;      // signal the value belongs to
  SignalCode fallback;  // RINEX 2: its signal where `code` has no pseudorange; else unset
  double scale = 1.0;   // the stored number is divided by it
};

// Contents of the header.
struct ObservationHeader {
  int version_hundredths = 0;  // 211, 304, ...
  char file_system = 'G';      // 'M' for mixed
  RinexTimeSystem time_system = RinexTimeSystem::kGps;
  // Types by system letter; all LEO satellites (L, M, N, O) are under 'L'. In RINEX 2 every system
  // has the same columns.
  std::map<char, std::vector<ObservationType>> types;
  Eigen::Vector3d approximate_p_e = Eigen::Vector3d::Zero();    // m, marker; zero: not given
  Eigen::Vector3d antenna_delta_hen = Eigen::Vector3d::Zero();  // m: height, east, north
  std::string marker, antenna;
  double interval_s = 0.0;  // 0: not given
  bool strength_in_dbhz = true;

  bool is_version_2() const { return version_hundredths < 300; }
};

// The parser takes the header line by line: at the start of the file, and again from the event
// records within it, which may change the observation types.
class ObservationHeaderParser {
 public:
  // Each function takes a line and returns the error, if there is one.
  std::optional<std::string> first_line(std::string_view line);
  std::optional<std::string> line(std::string_view line);
  // Completes what depends on several lines, after the last line of a block. Returns the error, if
  // there is one.
  std::optional<std::string> finish();

  const ObservationHeader& header() const { return header_; }

 private:
  std::optional<std::string> types_line(std::string_view line);
  std::optional<std::string> scale_line(std::string_view line);
  std::optional<std::string> types_line_2(std::string_view line);
  double scale_of(char system, const std::string& name) const;

  struct Scale {
    char system = 0;
    double factor = 1.0;
    std::vector<std::string> names;  // empty: all types of the system
  };
  ObservationHeader header_;
  std::map<char, std::vector<std::string>> names_;  // as written: "C1C", in RINEX 2 "C1" under 'G'
  std::map<char, std::size_t> expected_;            // number of names announced
  std::vector<Scale> scales_;
  char open_system_ = 0;  // system whose list goes on in a continuation line
};

}  // namespace leonav
