// This unit gives the antennas of a simulated run.
#pragma once
#include <vector>

#include "core/gnss/propagation/antenna_model.h"
#include "tools/sim/sky/true_sky.h"

namespace leonav::sim {

// Returns phase centres in the centres of mass and at the receiver's reference point, for every
// direction. They are published explicitly, because an unknown pattern does not count as zero.
std::vector<AntennaPattern> ideal_antennas(const Scenario& scenario, const TrueSky& sky);

}  // namespace leonav::sim
