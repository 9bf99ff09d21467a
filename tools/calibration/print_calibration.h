// What a calibration has found, for people and for programs.
#pragma once
#include <iosfwd>
#include <string>

#include "tools/calibration/calibrate.h"

namespace leonav {

// A table, what the log does not tell and why, and the lines for the configuration.
void print_calibration(const Calibration& calibration, std::ostream& out);
// {"passes": .., "settled": .., "lever_arm_forward_m": {"configured", "found", "sigma",
// "observed", "compared"}, ..} in the units of the names.
std::string json_of(const Calibration& calibration);

}  // namespace leonav
