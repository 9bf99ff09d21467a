// Constellations that need no file.
#pragma once
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// GPS 30 satellites, Galileo 24, BeiDou 5 geostationary, 7 inclined geosynchronous and 24 medium
// ones; LEO: the papers' 160 at 970 km (Remote Sensing 2024, 16, 1782, section 3.1).
ConstellationConfig nominal_constellation(System system);

}  // namespace leonav::sim
