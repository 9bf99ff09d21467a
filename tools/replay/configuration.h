// Which configuration a replay runs with: the one given, or the one the journal recorded.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/daemon_config.h"
#include "drivers/lcm/run_configuration.h"

namespace leonav {

struct ReplayConfiguration {
  DaemonConfig config;
  std::string origin;       // in words
  std::string differences;  // from what the journal was written with, in words; empty: none known
};

// The first message of a journal; nullopt: the log holds none. Throws EventLogError.
std::optional<RunConfiguration> recorded_configuration(const std::string& log);

// `file`: of the command line; nullopt: take what the log holds. Throws ConfigError; UsageError
// if there is neither.
ReplayConfiguration choose_configuration(const std::string& log,
                                         const std::optional<std::string>& file,
                                         const std::vector<std::string>& overrides);

}  // namespace leonav
