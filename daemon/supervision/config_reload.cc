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
                           Journal* journal)
    : load_(std::move(load)), running_(running), journal_(journal) {}

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
  if (!running_->commands.key_file.empty())
    spdlog::info("{}: the key was read at the start; another one needs a restart",
                 running_->commands.key_file);
  take_reloadable(read, running_);
  journal_->set_limits(limits_of(running_->journal));
  set_log_level(running_->log.level);
}

}  // namespace leonav
