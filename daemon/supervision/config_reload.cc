#include "daemon/supervision/config_reload.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "daemon/config/config_changes.h"
#include "daemon/supervision/log_level.h"

namespace leonav {
namespace {

constexpr double kStalled_s = 2.0;  // a warning says that reading takes longer

void tell(const ConfigChange& change) {
  spdlog::log(change.is_reloadable ? spdlog::level::info : spdlog::level::warn, "{}: {} -> {}: {}",
              change.path, change.before, change.after,
              change.is_reloadable ? "in effect" : "needs a restart");
}

}  // namespace

// The file of the key is that of the start: another name is a change of the configuration, and
// needs a restart.
ConfigReload::ConfigReload(std::function<DaemonConfig()> load, DaemonConfig* running,
                           Journal* journal, CommandGate* gate)
    : running_(running),
      journal_(journal),
      gate_(gate),
      reading_([load = std::move(load),
                key_file = gate == nullptr ? std::string() : running->commands.key_file] {
        return read(load, key_file);
      }) {}

ConfigReload::Files ConfigReload::read(const std::function<DaemonConfig()>& load,
                                       const std::string& key_file) {
  Files files;
  try {
    files.config = load();
  } catch (const std::exception& error) {
    files.problem = error.what();
    return files;
  }
  if (key_file.empty()) return files;
  try {
    files.key = CommandKey::from_file(key_file);
  } catch (const std::exception& error) {
    files.key_problem = error.what();
  }
  return files;
}

void ConfigReload::ask() {
  if (is_under_way()) {
    is_asked_again_ = true;
  } else {
    begin();
  }
}

void ConfigReload::begin() {
  is_asked_again_ = is_waiting_told_ = false;
  since_begin_ = Stopwatch();
  try {
    reading_.begin();
  } catch (const std::exception& error) {
    spdlog::error("SIGHUP: the configuration is not read again: {}", error.what());
  }
}

void ConfigReload::look() {
  if (!is_under_way()) return;
  const auto files = reading_.take();
  if (!files) return tell_waiting();
  if (files->config) {
    put_into_effect(*files);
  } else {
    spdlog::error("SIGHUP: the configuration has errors, nothing is changed: {}", files->problem);
  }
  if (is_asked_again_) begin();
}

void ConfigReload::tell_waiting() {
  if (is_waiting_told_ || static_cast<double>(since_begin_.nanoseconds()) * 1e-9 < kStalled_s)
    return;
  is_waiting_told_ = true;
  spdlog::warn("SIGHUP: the disk of the configuration does not answer; nothing is changed yet");
}

void ConfigReload::put_into_effect(const Files& files) {
  const DaemonConfig& read = *files.config;
  const auto changes = changes_between(running_->source, read.source);
  // Logged at the level that holds or at the one that will, whichever lets more through.
  set_log_level(std::min(running_->log.level, read.log.level));
  spdlog::info("SIGHUP: {} read again{}", read.source.name,
               changes.empty() ? ", nothing has changed" : "");
  for (const ConfigChange& change : changes) tell(change);
  take_command_key(files);
  take_reloadable(read, running_);
  journal_->set_limits(limits_of(running_->journal));
  set_log_level(running_->log.level);
}

void ConfigReload::take_command_key(const Files& files) {
  if (files.key) {
    gate_->set_key(*files.key);
    spdlog::info("{}: the key for commands is read again", running_->commands.key_file);
  } else if (!files.key_problem.empty()) {
    spdlog::error("{}; the key that was read before is still in effect", files.key_problem);
  }
}

}  // namespace leonav
