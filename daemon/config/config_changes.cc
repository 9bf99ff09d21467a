#include "daemon/config/config_changes.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

namespace leonav {
namespace {

// No answer depends on these keys, so that a journal replays whenever they were changed.
constexpr std::array<std::string_view, 7> kReloadable = {
    "journal.outputs",  "journal.flush_interval_s", "journal.piece_mb", "journal.piece_s",
    "journal.total_mb", "journal.kept_mb",          "log.level"};

bool is_reloadable(const std::string& path) {
  return std::find(kReloadable.begin(), kReloadable.end(), path) != kReloadable.end();
}

std::map<std::string_view, std::string_view> values_of(const ConfigOrigin& source) {
  std::map<std::string_view, std::string_view> values;
  for (const ConfigKey& key : source.keys) values[key.path] = key.value;
  return values;
}

}  // namespace

std::vector<ConfigChange> changes_between(const ConfigOrigin& running, const ConfigOrigin& read) {
  const auto before = values_of(running), after = values_of(read);
  const auto value = [](const auto& values, const std::string& path) {
    const auto found = values.find(path);
    return found == values.end() ? std::string() : std::string(found->second);
  };
  std::vector<ConfigChange> changes;
  const auto compare = [&](const std::string& path) {
    const std::string was = value(before, path), is = value(after, path);
    if (was != is) changes.push_back({path, was, is, is_reloadable(path)});
  };
  for (const ConfigKey& key : read.keys) compare(key.path);
  for (const ConfigKey& key : running.keys)
    if (!after.contains(key.path)) compare(key.path);
  return changes;
}

void take_reloadable(const DaemonConfig& read, DaemonConfig* running) {
  running->journal.outputs = read.journal.outputs;
  running->journal.flush_interval_s = read.journal.flush_interval_s;
  running->journal.piece_mb = read.journal.piece_mb;
  running->journal.piece_s = read.journal.piece_s;
  running->journal.total_mb = read.journal.total_mb;
  running->journal.kept_mb = read.journal.kept_mb;
  running->log = read.log;
  for (ConfigKey& key : running->source.keys) {
    const auto now = std::find_if(read.source.keys.begin(), read.source.keys.end(),
                                  [&](const ConfigKey& one) { return one.path == key.path; });
    if (is_reloadable(key.path) && now != read.source.keys.end()) key = *now;
  }
}

}  // namespace leonav
