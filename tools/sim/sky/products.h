// What the receiver is told of orbits and clocks by a precise product: the truth with errors, as
// nodes.
#pragma once
#include <vector>

#include "tools/dataset/product_schedule.h"
#include "tools/sim/sky/true_sky.h"

namespace leonav::sim {

struct Products {
  std::vector<OrbitEpoch> orbits;  // positions with clocks, in order of time
  std::vector<OrbitEpoch> clocks;  // clocks alone
};

// Of the constellations that are told of by precise products.
Products make_products(const Scenario& scenario, const TrueSky& sky);

}  // namespace leonav::sim
