// The ConfigReload reads the configuration again, and puts its reloadable keys into effect. The key
// for commands, which is in a file of its own, is read again with it.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "daemon/commands/command_gate.h"
#include "daemon/config/daemon_config.h"
#include "daemon/journal/journal.h"
#include "daemon/threads/counters.h"
#include "daemon/threads/disk_reading.h"

namespace leonav {

// All files are read in another thread, so that `main` waits for no disk.
class ConfigReload {
 public:
  // `load` reads the configuration; it may outlive this object, so it must hold all that it uses.
  // `running` gets the reloadable keys. `gate`: nullptr where commands need no key.
  ConfigReload(std::function<DaemonConfig()> load, DaemonConfig* running, Journal* journal,
               CommandGate* gate = nullptr);

  // Begins to read; where that is under way, it is done once more behind it. Never waits.
  void ask();
  bool is_under_way() const { return reading_.is_under_way(); }
  // Puts into effect what has been read meanwhile, if that has come to its end. Logs each change,
  // and whether it is in effect or needs a restart. A configuration that is wrong changes nothing;
  // where the file of the key is wrong, the key before holds on. Never waits.
  void look();

 private:
  // What is in the files; `problem`: why the configuration cannot be used.
  struct Files {
    std::optional<DaemonConfig> config;
    std::string problem;
    std::optional<CommandKey> key;
    std::string key_problem;
  };

  static Files read(const std::function<DaemonConfig()>& load, const std::string& key_file);
  void begin();
  void tell_waiting();
  void put_into_effect(const Files& files);
  void take_command_key(const Files& files);

  DaemonConfig* running_;
  Journal* journal_;
  CommandGate* gate_;
  DiskReading<Files> reading_;
  Stopwatch since_begin_;
  bool is_waiting_told_ = false, is_asked_again_ = false;
};

}  // namespace leonav
