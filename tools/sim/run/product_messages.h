// This unit schedules the orbits and clocks that the simulated receiver gets.
#pragma once
#include <vector>

#include "tools/import/product_schedule.h"
#include "tools/sim/faults/fault_script.h"
#include "tools/sim/sky/products.h"
#include "tools/sim/sky/true_sky.h"

namespace leonav::sim {

// Returns the products of the scenario, with the orbit errors of the fault script.
Products provided_products(const Scenario& scenario, const TrueSky& sky, const FaultScript& faults);

// Returns the products in order of arrival.
std::vector<ScheduledOrbitEpoch> in_order_of_arrival(Products products, GpsTime start);

}  // namespace leonav::sim
