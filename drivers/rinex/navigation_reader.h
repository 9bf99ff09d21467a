// This unit reads a RINEX navigation file, versions 2.00 to 3.05.
#pragma once
#include <string>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"
#include "drivers/rinex/read_counts.h"

namespace leonav {

// Contents of a file, with counts of what was skipped.
struct NavigationFile {
  std::vector<Ephemeris> ephemerides;  // in file order
  KlobucharModel klobuchar;            // invalid if the header has none
  ReadCounts counts;                   // records
};

// Reads a whole file. Source: RINEX 2.11, table A3; RINEX 3.05, tables A5 to A16. It uses the
// records of GPS, Galileo (I/NAV and F/NAV by the data source bits) and BeiDou and counts those of
// other systems. Times are converted to GPS time. A damaged record is counted with its line and
// skipped; its neighbours are kept. Throws FileError if the file cannot be opened, is compressed,
// is no RINEX navigation file, or has a version other than 2 or 3.
NavigationFile read_navigation(const std::string& path);

}  // namespace leonav
