// Precise satellite clocks in RINEX clock files 2.00 and 3.00 to 3.04.
// Source: RINEX Extensions to Handle Clock Information, versions 2.00 (J. Ray, W. Gurtner 1999),
// 3.02 (2010) and 3.04 (IGS 2017).
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/satellite_catalog.h"
#include "drivers/text/line_reader.h"

namespace leonav {

struct ClockEpoch {
  GpsTime time;
  std::vector<PreciseState> states;  // clock only, sorted by satellite
};

// What a file holds besides the clocks handed out.
struct ClockCounts {
  struct Problem {
    long line = 0;
    std::string what;
  };
  std::uint64_t states = 0;
  std::uint64_t other_records =
      0;                           // receiver clocks, discontinuities, calibration (AR, CR, DR, MS)
  std::uint64_t other_system = 0;  // satellite clocks of systems leonav does not use
  std::uint64_t bad_clocks = 0;    // beyond 0.1 s, as bad ones are marked
  std::uint64_t damaged_lines = 0;
  std::vector<Problem> problems;  // the first 20 damaged lines
};

// Reads one file epoch by epoch: it may be longer than what fits in memory.
class ClockReader {
 public:
  // Reads the header. Throws FileError if the file cannot be read, is no clock file of a version
  // known, is in an unknown time system or ends within its header.
  explicit ClockReader(const std::string& path);

  // The next epoch in which a satellite of leonav's has a clock; false at the end. Epochs are in
  // the order of the file, so that a damaged time costs that record and none after it: the caller
  // sorts. Throws FileError at the end of a file that had no such clock at all.
  bool next(ClockEpoch* epoch);

  double version() const { return version_; }
  const std::string& time_system() const { return time_system_; }  // as in the file, e.g. "GPS"
  const ClockCounts& counts() const { return counts_; }

 private:
  void read_first_line();
  void read_header();
  void set_time_system(std::string_view name);
  bool read_record(std::string_view line, PreciseState* state);
  std::optional<GpsTime> read_time() const;  // of the fields at hand
  bool read_clock(SatelliteId satellite, PreciseState* state);
  bool damaged(const std::string& what);

  LineReader lines_;
  double version_ = 0.0;
  std::string time_system_ = "GPS";
  bool time_system_known_ = false;
  ClockCounts counts_;
  int continuation_lines_ = 0;               // of the record last read, still to come
  std::array<std::string_view, 12> fields_;  // of the line at hand, behind the name
  std::size_t field_count_ = 0;
  PreciseState ahead_;  // the first clock of the next epoch
  bool has_ahead_ = false;
};

}  // namespace leonav
