// The gate of commands that the configuration asks for.
#pragma once
#include <optional>

#include "daemon/commands/command_gate.h"
#include "daemon/config/daemon_config.h"

namespace leonav {

// nullopt: commands need no key. Throws ConfigError where its file cannot be used.
std::optional<CommandGate> configured_gate(const DaemonConfig& config);

}  // namespace leonav
