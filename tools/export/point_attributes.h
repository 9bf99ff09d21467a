// This unit lists what the formats for maps tell of a point besides its position and time.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/angle.h"
#include "drivers/csv/solution_csv.h"

namespace leonav {

// One attribute, named as the column of solution.csv.
struct PointAttribute {
  std::string_view name;
  std::optional<double> value;
  int decimals = 0;
};

// Returns all attributes in the order of solution.csv's columns, those that are unknown too: height
// above the ellipsoid, velocity, attitude, sigmas, satellites, PDOP, protection levels.
std::vector<PointAttribute> attributes_of(const SolutionRow& row);

// Returns a decimal number; 9 decimals of a degree are 0.1 mm.
std::string decimal(double value, int decimals);

}  // namespace leonav
