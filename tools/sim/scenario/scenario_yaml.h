// This unit reads scenario.yaml into a Scenario.
#pragma once
#include <string>
#include <vector>

#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Absent keys keep their defaults; each override is "group.key=value".
//
// Throws ConfigError, as load_config() does, for a key that is unknown, repeated, of the wrong type
// or out of range, with file, line and remedy. Files named in it are relative to the scenario's
// folder.
Scenario load_scenario(const std::string& path, const std::vector<std::string>& overrides = {});
Scenario load_scenario_text(const std::string& text, const std::string& name,
                            const std::vector<std::string>& overrides = {});

}  // namespace leonav::sim
