#include "tools/sim/run/antennas.h"

#include <set>

#include "tools/sim/signals/signal_plan.h"

namespace leonav::sim {

std::vector<AntennaPattern> ideal_antennas(const Scenario& scenario, const TrueSky& sky) {
  std::vector<AntennaPattern> patterns;
  std::set<System> systems;
  for (const TrueSatellite& satellite : sky.satellites) systems.insert(satellite.id.system);
  AntennaPattern pattern;
  pattern.is_receiver = true;
  for (const System system : systems) {
    pattern.satellite = {system, 0};
    for (const SignalCode code : signals_of(scenario, system)) {
      pattern.band = code.band;
      patterns.push_back(pattern);
    }
  }
  pattern.is_receiver = false;
  for (const TrueSatellite& satellite : sky.satellites) {
    pattern.satellite = satellite.id;
    for (const SignalCode code : signals_of(scenario, satellite.id.system)) {
      pattern.band = code.band;
      patterns.push_back(pattern);
    }
  }
  return patterns;
}

}  // namespace leonav::sim
