// This unit parses one record of a RINEX 2 or 3 navigation file: the lines from a satellite name to
// the next.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"

namespace leonav {

// Properties of the file that determine the layout of its records.
struct NavigationLayout {
  bool is_version_2 = false;
  char system = 'G';  // of the whole file, in RINEX 2
};

// Returns whether a record begins with this line.
bool starts_navigation_record(std::string_view line, const NavigationLayout& layout);

// Returns the satellite in a record's first line as RINEX 3 writes it: "G05".
std::string record_satellite(std::string_view line, const NavigationLayout& layout);

// Parses a record of a satellite that leonav uses. Returns the reason why it cannot be used, or an
// empty text if it can.
std::string_view parse_navigation_record(const std::vector<std::string>& lines,
                                         const NavigationLayout& layout, Ephemeris* ephemeris);

}  // namespace leonav
