// How many satellites a scenario's vehicle sees, and how well they stand.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Of a set of systems.
struct SystemCombination {
  std::string name;
  std::vector<System> systems;
};

struct SkySeries {
  std::vector<double> satellites;  // per epoch
  std::vector<double> pdop;        // of the epochs that have one
};

// Every `step_s` along the route, above `mask` (rad). `in_the_sky`: all that are up; `tracked`:
// those of which the receiver gives a pseudorange on every signal, where the scenario's places hide
// some.
struct SkyStatistics {
  std::vector<SystemCombination> combinations;
  std::vector<SkySeries> in_the_sky, tracked;  // by combination
};
SkyStatistics sky_statistics(const Scenario& scenario, double mask, double step_s);

// As tables, with the papers' means beside those that they give: Remote Sensing 2024, 16, 1782,
// figure 4, and Electronics 2024, 13, 508, figures 3 and 4 (Beijing, urban, mask 15 degrees).
void print(const SkyStatistics& statistics, std::ostream& stream);

}  // namespace leonav::sim
