// SP3-d orbit files.
#pragma once
#include <span>
#include <string>

#include "tools/dataset/product_schedule.h"

namespace leonav::sim {

// Source: S. Hilla, The Extended Standard Product 3 Orbit Format (SP3-d), 2016. Positions are
// rounded to 1 mm, clocks to 1 ps; a clock that is not known is written as 999999.999999. The flags
// of PreciseState go into their columns. `epochs`: of one node interval, in order of time, not
// empty. `comment`: of at most 77 characters. Throws FileError.
void write_sp3(const std::string& path, std::span<const OrbitEpoch> epochs,
               const std::string& comment);

}  // namespace leonav::sim
