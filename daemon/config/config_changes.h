// These functions compare two configurations of a daemon that runs.
#pragma once
#include <string>
#include <vector>

#include "daemon/config/daemon_config.h"

namespace leonav {

// A key whose effective value has changed.
struct ConfigChange {
  std::string path, before, after;  // values in YAML; empty: the key is not there
  bool is_reloadable = false;       // in effect without a restart

  bool operator==(const ConfigChange&) const = default;
};

// Returns the changes from what a daemon runs with to what its file says now, in the order of the
// reference.
std::vector<ConfigChange> changes_between(const ConfigOrigin& running, const ConfigOrigin& read);

// Sets the reloadable keys of `running`, and where they come from, to those of `read`.
void take_reloadable(const DaemonConfig& read, DaemonConfig* running);

}  // namespace leonav
