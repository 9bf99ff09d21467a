// This unit defines which parts of a scenario a recorded run replaces.
#pragma once
#include <string>
#include <vector>

#include "tools/sim/scenario/faults_config.h"

namespace leonav::sim {

// Throws std::runtime_error, with file and line, for a fault that an overlay cannot apply to a
// recording.
//
// Such faults concern the IMU, the messages' times, the receiver itself, or, except outages, the
// recording's own satellites.
void check_overlay_faults(const std::vector<Fault>& faults);

// Returns those of the given keys that the recording replaces.
std::vector<std::string> keys_of_the_recording(const std::vector<std::string>& given);

}  // namespace leonav::sim
