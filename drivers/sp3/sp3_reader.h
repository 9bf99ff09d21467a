// This unit reads precise orbits in SP3-c and SP3-d. Source: S. Hilla, The Extended Standard
// Product 3 Orbit Format (SP3-c) 2010, (SP3-d) 2016.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/gnss/orbits/ephemeris_store.h"

namespace leonav {

// The states of one epoch.
struct Sp3Epoch {
  GpsTime time;
  std::vector<PreciseState> states;  // sorted by satellite
};

// A line that was skipped and its error; the file is usable without it.
struct Sp3Problem {
  long line = 0;
  std::string what;
};

// Contents of a file, with counts of what was skipped.
struct Sp3File {
  char version = 0;                 // 'c' or 'd'
  std::string time_system;          // as in the file: "GPS", "GAL", "BDT", "QZS", "UTC"
  std::string frame;                // e.g. "IGb14"
  int satellites_listed = 0;        // in the header, all systems
  std::vector<Sp3Epoch> epochs;     // in increasing time; times are GPS time
  std::uint64_t states = 0;         // in all epochs
  std::uint64_t other_system = 0;   // position lines of systems leonav does not use
  std::uint64_t bad_positions = 0;  // position 0 0 0: "bad or absent" by the format
  std::uint64_t bad_clocks = 0;     // clock 999999.999999: the state is kept, its clock is NaN
  std::uint64_t clock_events = 0;   // states flagged E: the clock was changed since the one before
  std::uint64_t maneuvers = 0;      // states flagged M: the orbit was changed
  std::uint64_t predicted = 0;      // states flagged P: clock, orbit or both
  std::uint64_t damaged_lines = 0;
  bool truncated = false;            // no EOF line
  std::vector<Sp3Problem> problems;  // the first 20 damaged lines
};

// Reads a whole file. Throws FileError if the file cannot be read, is not SP3-c or -d, or has no
// usable state.
Sp3File read_sp3(const std::string& path);

}  // namespace leonav
