// This unit chooses the configuration of a replay: the given one, or the one that the journal
// recorded.
#pragma once
#include <optional>
#include <string>

#include "daemon/config/daemon_config.h"
#include "drivers/lcm/run_configuration.h"
#include "tools/common/arguments.h"

namespace leonav {

// The chosen configuration.
struct ReplayConfiguration {
  DaemonConfig config;
  std::string origin;       // in words
  std::string differences;  // to the journal's configuration, in words; empty: none known
};

// Returns the first message of a journal; nullopt if the log has none. Throws EventLogError.
std::optional<RunConfiguration> recorded_configuration(const std::string& log);

// Chooses the configuration of the command line (configuration_options.h), else the one that the
// log holds, with the overrides of --set. Throws ConfigError, and UsageError if there is neither or
// if --set names a preset over the one that the log holds.
ReplayConfiguration choose_configuration(const std::string& log, const Arguments& arguments);

}  // namespace leonav
