// The gate of commands that the configuration asks for.
#pragma once
#include <memory>

#include "daemon/commands/command_gate.h"
#include "daemon/config/daemon_config.h"

namespace leonav {

// nullptr: commands need no key. Throws ConfigError where its file cannot be used.
std::unique_ptr<CommandGate> configured_gate(const DaemonConfig& config);

}  // namespace leonav
