// One record of a RINEX navigation file: the lines from a satellite name to the next.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/ephemeris.h"

namespace leonav {

// What the layout of the records depends on.
struct NavigationLayout {
  bool is_version_2 = false;
  char system = 'G';  // of the whole file, in RINEX 2
};

// Whether a record begins with this line.
bool starts_navigation_record(std::string_view line, const NavigationLayout& layout);

// The satellite of a record's first line as RINEX 3 writes it: "G05".
std::string record_satellite(std::string_view line, const NavigationLayout& layout);

// Reads a record of a satellite that leonav uses. Returns why it cannot be used; empty: it can.
std::string_view parse_navigation_record(const std::vector<std::string>& lines,
                                         const NavigationLayout& layout, Ephemeris* ephemeris);

}  // namespace leonav
