#include "daemon/supervision/config_reload.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "daemon/config/config_changes.h"
#include "daemon/supervision/log_level.h"

namespace leonav {
namespace {

void tell(const ConfigChange& change) {
  spdlog::log(change.is_reloadable ? spdlog::level::info : spdlog::level::warn, "{}: {} -> {}: {}",
              change.path, change.before, change.after,
              change.is_reloadable ? "in effect" : "needs a restart");
}

}  // namespace

ConfigReload::ConfigReload(std::function<DaemonConfig()> load, DaemonConfig* running,
                           Journal* journal, CommandGate* gate)
    : load_(std::move(load)), running_(running), journal_(journal), gate_(gate) {}

void ConfigReload::reload() {
  try {
    put_into_effect(load_());
  } catch (const std::exception& error) {
    spdlog::error("SIGHUP: the configuration has errors, nothing is changed: {}", error.what());
  }
}

void ConfigReload::put_into_effect(const DaemonConfig& read) {
  const auto changes = changes_between(running_->source, read.source);
  // Logged at the level that holds or at the one that will, whichever lets more through.
  set_log_level(std::min(running_->log.level, read.log.level));
  spdlog::info("SIGHUP: {} read again{}", read.source.name,
               changes.empty() ? ", nothing has changed" : "");
  for (const ConfigChange& change : changes) tell(change);
  read_command_key();
  take_reloadable(read, running_);
  journal_->set_limits(limits_of(running_->journal));
  set_log_level(running_->log.level);
}

// Another name of the file is a change of the configuration, and needs a restart.
void ConfigReload::read_command_key() {
  if (gate_ == nullptr) return;
  const std::string& path = running_->commands.key_file;
  try {
    gate_->set_key(CommandKey::from_file(path));
    spdlog::info("{}: the key for commands is read again", path);
  } catch (const std::exception& error) {
    spdlog::error("{}; the key that was read before is still in effect", error.what());
  }
}

}  // namespace leonav
