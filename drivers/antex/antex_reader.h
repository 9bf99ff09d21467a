// This unit reads antenna models in ANTEX 1.3 and 1.4. Source: M. Rothacher, R. Schmid, ANTEX: The
// Antenna Exchange Format, Version 1.4 (2010).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/propagation/antenna_model.h"

namespace leonav {

// Choice of the models to keep: those of all satellites that are valid at `time` (unset: at any
// time), and that of one receiver antenna, named as in RINEX headers: twenty characters, type and,
// in the last four, radome ("ASH701945E_M    SCIS"). An empty name: none.
struct AntexSelection {
  GpsTime time;
  std::string receiver_antenna;
};

// Outcome of the search for the receiver antenna.
enum class ReceiverMatch : std::uint8_t {
  kNotAsked,
  kExact,
  kWithoutRadome,  // the file has the type only with radome NONE: some millimetres
  kAbsent,         // the file does not have the type
};

// A part that was skipped and its error; the file is usable without it.
struct AntexProblem {
  long line = 0;
  std::string what;
};

// Patterns selected from a file, with counts of what was skipped.
struct AntexFile {
  // One pattern per band of each satellite antenna in the file's order, then of the receiver
  // antenna. A satellite's varies by nadir angle alone: where the file has azimuths it is the mean
  // over them.
  std::vector<AntennaPattern> satellites;
  std::vector<AntennaPattern> receiver;
  ReceiverMatch match = ReceiverMatch::kNotAsked;
  std::string receiver_found;            // the name in the file
  std::uint64_t satellite_antennas = 0;  // kept
  std::uint64_t not_valid = 0;           // satellite antennas of another time
  std::uint64_t other_system = 0;      // satellite antennas, receivers' bands, of systems not used
  std::uint64_t unknown_band = 0;      // bands that leonav does not have
  std::uint64_t damaged = 0;           // antennas left out
  std::uint64_t coarsened = 0;         // grids by azimuth too fine to keep: their mean was taken
  bool truncated = false;              // the file ends within an antenna
  std::vector<AntexProblem> problems;  // the first 20
};

// Returns "ASH701945E_M SCIS", however spaced, as the twenty characters of the format; a name
// without radome gets NONE. An empty name stays empty.
std::string antenna_name(std::string_view text);

// Reads a whole file. Throws FileError for a file that cannot be read at all, is no ANTEX file, has
// relative models (which differ from absolute ones by centimetres) or nothing of the selection.
AntexFile read_antex(const std::string& path, const AntexSelection& selection);

}  // namespace leonav
