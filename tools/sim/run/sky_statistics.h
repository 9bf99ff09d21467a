// This unit counts the satellites that a scenario's vehicle sees, with their geometry.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// A combination of systems.
struct SystemCombination {
  std::string name;
  std::vector<System> systems;
};

// Series of one combination.
struct SkySeries {
  std::vector<double> satellites;  // per epoch
  std::vector<double> pdop;        // of the epochs with a value
};

// Satellites every `step_s` along the route, above `mask` (rad). `in_the_sky` counts all that are
// up; `tracked` those with a pseudorange on every signal, where the scenario's places hide some.
struct SkyStatistics {
  std::vector<SystemCombination> combinations;
  std::vector<SkySeries> in_the_sky, tracked;  // by combination
};
SkyStatistics sky_statistics(const Scenario& scenario, double mask, double step_s);

// Prints tables, with the papers' means beside those for which the papers give one: Remote Sensing
// 2024, 16, 1782, figure 4, and Electronics 2024, 13, 508, figures 3 and 4 (Beijing, urban, mask 15
// degrees).
void print(const SkyStatistics& statistics, std::ostream& stream);

}  // namespace leonav::sim
