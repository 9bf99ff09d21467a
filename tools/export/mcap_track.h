// This unit writes a track as an MCAP file with messages of ROS 2.
#pragma once
#include <span>

#include "drivers/csv/solution_csv.h"
#include "tools/export/output_file.h"

namespace leonav {

// What was written.
struct McapCounts {
  std::uint64_t fixes = 0, odometries = 0;
};

// Writes NavSatFix and source of each point, and Odometry of each with an attitude; the origin of
// "map" is the first point. Precondition: there is a point. Throws std::runtime_error where a time
// is none that ROS can hold.
McapCounts write_mcap(std::span<const SolutionRow> rows, OutputFile* file);

}  // namespace leonav
