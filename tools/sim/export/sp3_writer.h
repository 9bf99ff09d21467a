// This unit writes SP3-d orbit files.
#pragma once
#include <span>
#include <string>

#include "tools/import/product_schedule.h"

namespace leonav::sim {

// Writes orbits and clocks. Source: S. Hilla, The Extended Standard Product 3 Orbit Format (SP3-d),
// 2016.
//
// Positions are rounded to 1 mm, clocks to 1 ps; an unknown clock is written as 999999.999999. The
// flags of PreciseState go into their columns. `epochs` have one node interval, are in order of
// time and not empty. `comment` has at most 77 characters. Throws FileError.
void write_sp3(const std::string& path, std::span<const OrbitEpoch> epochs,
               const std::string& comment);

}  // namespace leonav::sim
