// This unit draws the places of a drive through a town.
#pragma once
#include <vector>

#include "tools/sim/motion/gaussian_generator.h"
#include "tools/sim/scenario/places_config.h"

namespace leonav::sim {

// Returns segments by distance for `length_m`. The first is under an open sky; kinds and lengths of
// the others are drawn with the shares of the mix.
std::vector<PlaceSegment> city_places(PlaceMix mix, double length_m, GaussianGenerator random);

}  // namespace leonav::sim
