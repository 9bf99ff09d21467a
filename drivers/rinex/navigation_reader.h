// This unit reads a RINEX navigation file, versions 2.00 to 4.
#pragma once
#include <string>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "drivers/rinex/read_counts.h"

namespace leonav {

// Contents of a file, with counts of what was skipped.
struct NavigationFile {
  std::vector<Ephemeris> ephemerides;  // in file order
  // Group delays of CNAV and B-CNAV (RINEX 4), kBroadcastCode with the time at which they were
  // sent.
  std::vector<SignalBias> delays;
  KlobucharModel klobuchar;  // the first one; invalid if the file has none
  ReadCounts counts;         // records
};

// Reads a whole file. Source: RINEX 2.11, table A3; RINEX 3.05, tables A5 to A16; RINEX
// 4.01. It uses the records of GPS, Galileo (I/NAV and F/NAV by the data source bits, in RINEX 4
// by the record's name) and BeiDou and counts those of other systems, and of RINEX 4 those of other
// messages, time offsets, the Earth's orientation and other ionosphere models. Times are converted
// to GPS time. A damaged record is counted with its line and skipped; its neighbours are kept.
// Throws FileError if the file cannot be opened, is compressed, is no RINEX navigation file, or has
// a version other than 2 to 4.
NavigationFile read_navigation(const std::string& path);

}  // namespace leonav
