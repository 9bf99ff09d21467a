// What of a scenario a recorded run leaves no room for.
#pragma once
#include <string>
#include <vector>

#include "tools/sim/scenario/faults_config.h"

namespace leonav::sim {

// Throws std::runtime_error, naming file and line, for a fault that an overlay cannot lay over a
// recording: of the IMU, of the messages' times, of the receiver itself, or, but for outages, of
// satellites that are the recording's own.
void check_overlay_faults(const std::vector<Fault>& faults);

// Of the keys that a scenario gives, those that the recording says instead.
std::vector<std::string> keys_of_the_recording(const std::vector<std::string>& given);

}  // namespace leonav::sim
