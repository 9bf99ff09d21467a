// This unit prints a calibration as a table for people and as JSON for programs.
#pragma once
#include <iosfwd>
#include <string>

#include "tools/calibrate/calibrate.h"

namespace leonav {

// Prints a table, the reason for every quantity that the log does not determine, and the lines for
// the configuration.
void print_calibration(const CalibrationResult& calibration, std::ostream& out);
// Returns {"passes": .., "settled": .., "lever_arm_forward_m": {"configured", "found", "sigma",
// "observed", "compared"}, ..} in the units of the names.
std::string json_of(const CalibrationResult& calibration);

}  // namespace leonav
