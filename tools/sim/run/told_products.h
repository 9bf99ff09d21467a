// What the vehicle is told of orbits and clocks, in order of arrival.
#pragma once
#include <vector>

#include "tools/dataset/product_schedule.h"
#include "tools/sim/faults/fault_script.h"
#include "tools/sim/sky/products.h"
#include "tools/sim/sky/true_sky.h"

namespace leonav::sim {

// The products of the scenario, with orbits that the script makes bad.
Products told_products(const Scenario& scenario, const TrueSky& sky, const FaultScript& faults);

std::vector<ScheduledOrbitEpoch> in_order_of_arrival(Products products, GpsTime start);

}  // namespace leonav::sim
