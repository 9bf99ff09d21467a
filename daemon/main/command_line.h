// The CommandLine of leonavd: its options, and what they ask for.
#pragma once
#include "daemon/config/daemon_config.h"
#include "tools/common/arguments.h"

namespace leonav {

class CommandLine {
 public:
  CommandLine();

  // Reads the arguments, and prints what they ask for instead of a run. Returns whether the daemon
  // is to run. Throws UsageError, and ConfigError where the configuration to be checked is wrong.
  bool asks_for_run(int argc, char** argv);

  // The configuration with everything the command line changes in it, so that a journal holds it
  // all. Throws UsageError, ConfigError.
  DaemonConfig load() const;
  // The same while the daemon runs: from a file only, because a pipe could hold it up.
  DaemonConfig load_again() const;

 private:
  void print_configuration() const;

  Arguments arguments_;
};

}  // namespace leonav
