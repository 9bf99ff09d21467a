// RINEX 3.04 navigation files.
#pragma once
#include <span>
#include <string>

#include "core/gnss/ephemeris.h"

namespace leonav::sim {

// Source: RINEX 3.04, tables A6 (GPS), A8 (Galileo), A14 (BeiDou). Numbers have 13 digits, times of
// BeiDou are its own. LEO satellites have no record and are left out. Throws FileError.
void write_rinex_navigation(const std::string& path, std::span<const Ephemeris> ephemerides);

}  // namespace leonav::sim
