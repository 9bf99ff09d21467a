// This unit parses the lines of a RINEX observation file below the header: epoch lines and
// satellite records.
#pragma once
#include <boost/container/static_vector.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/signals/observation.h"
#include "drivers/rinex/observation_header.h"

namespace leonav {

// Contents of an epoch line.
struct EpochLine {
  GpsTime time;   // as written; unset if blank, which event records may leave
  int flag = 0;   // 0 and 1 measurements (1: after a power failure), 2-5 events, 6 cycle slips
  int count = 0;  // satellites, or lines that follow an event
  std::vector<std::string> satellites;  // RINEX 2 only; continuation lines are added later

  bool is_event() const { return flag > 1; }
};

// Return nullopt if the line is not a complete and plausible epoch line. The RINEX 2 form is parsed
// strictly, since only its columns distinguish such a line.
std::optional<EpochLine> parse_epoch_line_3(std::string_view line);
std::optional<EpochLine> parse_epoch_line_2(std::string_view line);

// Reads the names of up to 12 satellites in RINEX 2 from column 32 on. Returns false if one is not
// a letter with two digits. A blank letter is the system of the file.
bool append_satellites_2(std::string_view line, char file_system, std::size_t count,
                         std::vector<std::string>* satellites);

// The signals of one satellite.
struct SatelliteRecord {
  // There is room for every code that a header may list, since the choice is made later.
  std::vector<SignalObservation> signals;
  int damaged_fields = 0;  // fields that are no F14.3 numbers
};

// Parses the fields of `values` (16 columns each: value, loss-of-lock digit, strength digit)
// according to `types`. Blank and 0.0 are not measured.
void parse_values(std::string_view values, SatelliteId satellite,
                  const std::vector<ObservationType>& types, bool strength_in_dbhz,
                  SatelliteRecord* record);

}  // namespace leonav
