// The ConfigReload reads the configuration again, and puts its reloadable keys into effect.
#pragma once
#include <functional>

#include "daemon/config/daemon_config.h"
#include "daemon/journal/journal.h"

namespace leonav {

class ConfigReload {
 public:
  // `load` reads the configuration, `running` gets the reloadable keys.
  ConfigReload(std::function<DaemonConfig()> load, DaemonConfig* running, Journal* journal);

  // Logs each change, and whether it is in effect or needs a restart. A configuration that is wrong
  // changes nothing.
  void reload();

 private:
  void put_into_effect(const DaemonConfig& read);

  std::function<DaemonConfig()> load_;
  DaemonConfig* running_;
  Journal* journal_;
};

}  // namespace leonav
