#include "tools/sim/run/product_messages.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace leonav::sim {
namespace {

void falsify(const Scenario& scenario, const TrueSky& sky, const FaultScript& faults,
             std::vector<OrbitEpoch>* orbits) {
  std::map<SatelliteId, const TrueSatellite*> by_id;
  for (const TrueSatellite& satellite : sky.satellites) by_id[satellite.id] = &satellite;
  for (OrbitEpoch& epoch : *orbits) {
    const double t = seconds_between(epoch.time, scenario.start);
    for (PreciseState& state : epoch.states) {
      const Eigen::Vector3d error = faults.orbit_error_m(state.satellite, t);
      if (error.isZero()) continue;
      const OrbitState truth = by_id.at(state.satellite)->orbit.at(t);
      const Eigen::Vector3d radial = truth.p_i.normalized();
      const Eigen::Vector3d cross = truth.p_i.cross(truth.v_i).normalized();
      state.p_e +=
          to_earth(error.x() * cross.cross(radial) + error.y() * cross + error.z() * radial, t);
    }
  }
}

}  // namespace

Products provided_products(const Scenario& scenario, const TrueSky& sky,
                           const FaultScript& faults) {
  Products products = make_products(scenario, sky);
  if (faults.has(FaultKind::kBadOrbit)) falsify(scenario, sky, faults, &products.orbits);
  return products;
}

std::vector<ScheduledOrbitEpoch> in_order_of_arrival(Products products, GpsTime start) {
  auto all = schedule_orbits(std::move(products.orbits), start, kOrbitNodesAhead);
  auto clocks = schedule_orbits(std::move(products.clocks), start, kClockNodesAhead);
  std::ranges::move(clocks, std::back_inserter(all));
  std::ranges::stable_sort(all, {}, &ScheduledOrbitEpoch::arrival);
  return all;
}

}  // namespace leonav::sim
