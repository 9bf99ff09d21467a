// scenario.yaml -> Scenario.
#pragma once
#include <string>
#include <vector>

#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Keys that are absent keep their defaults. Throws ConfigError, as load_config() does: a key that
// is unknown, repeated, of the wrong type or out of range, with file, line and remedy. Each
// override is "group.key=value". Files that it names are relative to the scenario's folder.
Scenario load_scenario(const std::string& path, const std::vector<std::string>& overrides = {});
Scenario load_scenario_text(const std::string& text, const std::string& name,
                            const std::vector<std::string>& overrides = {});

}  // namespace leonav::sim
