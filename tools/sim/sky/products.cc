#include "tools/sim/sky/products.h"

#include <cmath>
#include <limits>
#include <map>

#include "core/gnss/signals/signal.h"
#include "tools/sim/sky/ephemeris_error.h"

namespace leonav::sim {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kNodesBeyond = kOrbitNodesAhead + 1;
constexpr int kClocksBeyond = 10;

using ByTime = std::map<GpsTime, std::vector<PreciseState>>;

std::vector<OrbitEpoch> in_order(ByTime* by_time) {
  std::vector<OrbitEpoch> epochs;
  for (auto& [time, states] : *by_time) epochs.push_back({time, std::move(states)});
  return epochs;
}

}  // namespace

Products make_products(const Scenario& scenario, const TrueSky& sky) {
  ByTime orbits, clocks;
  for (const TrueSatellite& satellite : sky.satellites) {
    const ConstellationConfig& c = scenario.constellations[satellite.constellation];
    if (c.provided == ProvidedProducts::kBroadcast) continue;
    const EphemerisError error(c.precise, satellite.id, period_s(satellite.orbit.at(0.0)),
                               scenario.seed, "product");
    const auto node = [&](double t) {
      PreciseState state;
      state.satellite = satellite.id;
      state.time = scenario.start.plus_seconds(t);
      state.clock_s = satellite.clock.at(t).offset_s + error.clock_m(t) / kSpeedOfLight;
      return state;
    };
    const double end = scenario.duration_s + kNodesBeyond * c.node_interval_s;
    for (double t = -kNodesBeyond * c.node_interval_s; t <= end; t += c.node_interval_s) {
      PreciseState state = node(t);
      const OrbitState truth = satellite.orbit.at(t);
      state.p_e = to_earth(truth.p_i + in_inertial(truth, error.orbit_m(t)), t);
      orbits[state.time].push_back(state);
    }
    const double last = scenario.duration_s + kClocksBeyond * c.clock_interval_s;
    for (double t = -kClocksBeyond * c.clock_interval_s; t <= last; t += c.clock_interval_s) {
      PreciseState state = node(t);
      state.p_e.setConstant(kNaN);
      clocks[state.time].push_back(state);
    }
  }
  return {in_order(&orbits), in_order(&clocks)};
}

}  // namespace leonav::sim
