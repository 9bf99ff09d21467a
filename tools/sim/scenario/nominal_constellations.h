// This unit gives nominal constellations that need no file.
#pragma once
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Returns the constellation of a system: GPS 31 satellites in the standard's slots, Galileo 24
// (Walker 24/3/1), BeiDou 8 geostationary, 10 inclined geosynchronous and 27 medium ones with their
// real numbers, and the papers' 160 LEO satellites at 970 km (Remote Sensing 2024, 16, 1782,
// section 3.1).
ConstellationConfig nominal_constellation(System system);

}  // namespace leonav::sim
