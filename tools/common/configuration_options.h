// This unit declares and reads the options that choose a configuration, equal in all programs that
// run the navigator.
#pragma once
#include <string>
#include <vector>

#include "daemon/config/load_config.h"
#include "tools/common/arguments.h"

namespace leonav {

// Declares --config FILE, --preset NAME and --set KEY=VALUE.
void add_configuration_options(Arguments* arguments);

// Returns whether --config or --preset is given. Throws UsageError if both are.
bool has_configuration(const Arguments& arguments);

// Loads the file, or the preset alone, with the overrides of --set and then `overrides`. Throws
// UsageError if neither is given or both are, ConfigError if the configuration is wrong or one of
// `checks` finds it so.
DaemonConfig load_configuration(const Arguments& arguments,
                                const std::vector<std::string>& overrides = {},
                                const std::vector<ConfigCheck>& checks = {});

}  // namespace leonav
