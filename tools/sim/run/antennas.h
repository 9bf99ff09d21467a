// The antennas of a simulated run.
#pragma once
#include <vector>

#include "core/gnss/antenna_model.h"
#include "tools/sim/sky/true_sky.h"

namespace leonav::sim {

// Phase centres in the centres of mass and at the receiver's reference point, whatever the
// direction, and told so: what is not told is not known to be zero.
std::vector<AntennaPattern> ideal_antennas(const TrueSky& sky);

}  // namespace leonav::sim
