// The places of a drive through a town.
#pragma once
#include <vector>

#include "tools/motion/gaussian_generator.h"
#include "tools/sim/scenario/places_config.h"

namespace leonav::sim {

// Segments by distance for `length_m`: begins under an open sky, then kinds and lengths drawn with
// the shares of the mix.
std::vector<PlaceSegment> city_places(PlaceMix mix, double length_m, GaussianGenerator random);

}  // namespace leonav::sim
