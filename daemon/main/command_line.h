// The CommandLine of leonavd: its options, and what they ask for.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "daemon/commands/command_gate.h"
#include "daemon/config/daemon_config.h"
#include "tools/common/arguments.h"

namespace leonav {

// What a run begins with.
struct RunConfiguration {
  DaemonConfig config;
  std::unique_ptr<CommandGate> gate;  // nullptr: commands need no key
};

class CommandLine {
 public:
  CommandLine();

  // Reads the arguments, and prints what they ask for instead of a run. Returns whether the daemon
  // is to run. Throws UsageError, and ConfigError where the configuration to be checked is wrong.
  bool asks_for_run(int argc, char** argv);

  // The configuration with everything the command line changes in it, so that a journal holds it
  // all. Throws UsageError; ConfigError, also where the file of the key for commands is wrong.
  RunConfiguration load() const;
  // The configuration while the daemon runs: from a file only, because a pipe could hold it up.
  DaemonConfig load_again() const;

 private:
  std::vector<std::string> overrides() const;
  void print_configuration() const;

  Arguments arguments_;
};

}  // namespace leonav
