// This unit produces precise orbit and clock products: the truth with errors, as nodes.
#pragma once
#include <vector>

#include "tools/import/product_schedule.h"
#include "tools/sim/sky/true_sky.h"

namespace leonav::sim {

// Orbits and clocks in order of time.
struct Products {
  std::vector<OrbitEpoch> orbits;  // positions with clocks, in order of time
  std::vector<OrbitEpoch> clocks;  // clocks alone
};

// Returns the products of the constellations that have precise ones.
Products make_products(const Scenario& scenario, const TrueSky& sky);

}  // namespace leonav::sim
