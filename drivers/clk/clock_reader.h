// This unit reads precise satellite clocks in RINEX clock files 2.00 and 3.00 to 3.04. Source:
// RINEX Extensions to Handle Clock Information, versions 2.00 (J. Ray, W. Gurtner 1999), 3.02
// (2010) and 3.04 (IGS 2017).
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/orbits/ephemeris_store.h"
#include "drivers/text/line_reader.h"

namespace leonav {

// The clocks of one epoch.
struct ClockEpoch {
  GpsTime time;
  std::vector<PreciseState> states;  // clock only, sorted by satellite
};

// Counts of a file's records, used and skipped.
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

// The reader streams one file epoch by epoch, because a file may be larger than the memory.
class ClockReader {
 public:
  // Reads the header. Throws FileError if the file cannot be read, is no clock file of a supported
  // version, is in an unknown time system, or ends within its header.
  explicit ClockReader(const std::string& path);

  // Reads the next epoch in which a satellite that leonav uses has a clock; returns false at the
  // end. Epochs come in the order of the file, so that a damaged time excludes only its own record;
  // the caller sorts them. Throws FileError at the end of a file without any such clock.
  bool next(ClockEpoch* epoch);

  double version() const { return version_; }
  const std::string& time_system() const { return time_system_; }  // as in the file, e.g. "GPS"
  const ClockCounts& counts() const { return counts_; }

 private:
  void read_first_line();
  void read_header();
  void set_time_system(std::string_view name);
  bool read_record(std::string_view line, PreciseState* state);
  std::optional<GpsTime> read_time() const;  // of the current fields
  bool read_clock(SatelliteId satellite, PreciseState* state);
  bool damaged(const std::string& what);

  LineReader lines_;
  double version_ = 0.0;
  std::string time_system_ = "GPS";
  bool time_system_known_ = false;
  ClockCounts counts_;
  int continuation_lines_ = 0;               // of the last record, not yet read
  std::array<std::string_view, 12> fields_;  // of the current line, after the name
  std::size_t field_count_ = 0;
  PreciseState next_epoch_clock_;  // the first clock of the next epoch
  bool has_next_epoch_clock_ = false;
};

}  // namespace leonav
