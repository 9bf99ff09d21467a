// This unit parses one record of a RINEX 4 navigation file: a line that begins with '>' and names
// kind, satellite and message, and the lines to the next such line.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/propagation/signal_bias_store.h"

namespace leonav {

// What a record gives.
struct NavigationRecord4 {
  std::optional<Ephemeris> ephemeris;
  std::vector<SignalBias> delays;  // kBroadcastCode, with the time at which they were sent
  std::optional<KlobucharModel> klobuchar;
};

// Returns whether a record begins with this line behind `lines_before` lines of another one. A
// satellite's name behind the second line is that of a record whose first line is lost.
bool starts_record_4(std::string_view line, std::size_t lines_before);

// Parses a record. Used are the elements of GPS LNAV, Galileo I/NAV and F/NAV, BeiDou D1, D2 and
// B-CNAV1, the group delays of GPS CNAV and CNAV-2, BeiDou B-CNAV1 and B-CNAV2, and the
// ionosphere of GPS LNAV. Returns the reason why the record or its elements cannot be used, or an
// empty text. Source: RINEX 4.01, 8.3 and tables A6 to A40.
std::string_view parse_record_4(const std::vector<std::string>& lines, NavigationRecord4* record);

}  // namespace leonav
