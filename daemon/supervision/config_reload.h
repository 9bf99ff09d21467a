// The ConfigReload reads the configuration again, and puts its reloadable keys into effect. The key
// for commands, which is in a file of its own, is read again with it.
#pragma once
#include <functional>

#include "daemon/commands/command_gate.h"
#include "daemon/config/daemon_config.h"
#include "daemon/journal/journal.h"

namespace leonav {

class ConfigReload {
 public:
  // `load` reads the configuration, `running` gets the reloadable keys. `gate`: nullptr where
  // commands need no key.
  ConfigReload(std::function<DaemonConfig()> load, DaemonConfig* running, Journal* journal,
               CommandGate* gate = nullptr);

  // Logs each change, and whether it is in effect or needs a restart. A configuration that is wrong
  // changes nothing; where the file of the key is wrong, the key before holds on.
  void reload();

 private:
  void put_into_effect(const DaemonConfig& read);
  void read_command_key();

  std::function<DaemonConfig()> load_;
  DaemonConfig* running_;
  Journal* journal_;
  CommandGate* gate_;
};

}  // namespace leonav
