// This unit writes RINEX clock files.
#pragma once
#include <span>
#include <string>

#include "tools/import/product_schedule.h"

namespace leonav::sim {

// Writes version 3.00, whose columns every reader supports, with 13 digits. States without a clock
// are left out. Throws FileError.
void write_rinex_clock(const std::string& path, std::span<const OrbitEpoch> epochs);

}  // namespace leonav::sim
