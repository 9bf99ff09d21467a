// This unit writes RINEX 3.04 navigation files.
#pragma once
#include <span>
#include <string>

#include "core/gnss/orbits/ephemeris.h"

namespace leonav::sim {

// Writes the ephemerides with 13 digits; times of BeiDou are in its own time. Source: RINEX 3.04,
// tables A6 (GPS), A8 (Galileo), A14 (BeiDou). LEO satellites have no record and are left out.
// Throws FileError.
void write_rinex_navigation(const std::string& path, std::span<const Ephemeris> ephemerides);

}  // namespace leonav::sim
