#include "tools/replay/configuration.h"

#include <algorithm>
#include <vector>

#include "daemon/config/load_config.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_log.h"
#include "tools/common/configuration_options.h"

namespace leonav {
namespace {

constexpr const char* kThisProgram = "leonavd " LEONAV_VERSION;

// Returns whether a key defines the destination of messages, not their content.
bool changes_no_answer(const std::string& path) {
  return path == "lcm.url" || path.starts_with("journal.");
}

const ConfigKey* find_key(const ConfigOrigin& source, const std::string& path) {
  const auto found = std::find_if(source.keys.begin(), source.keys.end(),
                                  [&](const ConfigKey& one) { return one.path == path; });
  return found == source.keys.end() ? nullptr : &*found;
}

// In single quotes where a shell would take it apart.
std::string shell_word(const std::string& text) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-+=:/,";
  if (text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

// " --set KEY=VALUE" for every key that the journal's run had otherwise.
std::string different_keys(const ConfigOrigin& recorded, const ConfigOrigin& used) {
  constexpr int kMostListed = 8;
  std::string list;
  int different = 0;
  for (const ConfigKey& key : recorded.keys) {
    const ConfigKey* now = find_key(used, key.path);
    if (key.path == "preset" || changes_no_answer(key.path)) continue;
    if (now != nullptr && now->value == key.value) continue;
    // Both follow from another key, which is listed itself.
    if (now != nullptr && !now->given && !key.given) continue;
    if (++different <= kMostListed) list += " --set " + shell_word(key.path + "=" + key.value);
  }
  if (different > kMostListed) {
    list += " and " + std::to_string(different - kMostListed) + " more keys";
  }
  return list;
}

// A preset is beneath the text of the journal, which holds every key.
void refuse_preset(const std::vector<std::string>& overrides) {
  for (const std::string& one : overrides) {
    if (one.starts_with("preset=")) {
      throw UsageError("--set " + one +
                       ": a preset is beneath the journal's own configuration and changes none of "
                       "its keys; --preset NAME replaces that configuration");
    }
  }
}

DaemonConfig load_recorded(const RunConfiguration& recorded, const std::string& name,
                           const std::vector<std::string>& overrides) {
  // Journals of older versions hold the text of the file, with the overrides beside it.
  std::vector<std::string> all = recorded.overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return load_config_text(recorded.text, name, all);
}

std::string compare(const RunConfiguration& recorded, const std::string& name,
                    const ConfigOrigin& used) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  try {
    const std::string keys = different_keys(load_recorded(recorded, name, {}).source, used);
    if (!keys.empty()) add("the journal was written with" + keys);
  } catch (const ConfigError& error) {
    add(std::string("the journal was written with another configuration: ") + error.what());
  }
  if (recorded.program != kThisProgram) {
    add("the journal was written by " + recorded.program + ", this is " + kThisProgram);
  }
  return text;
}

}  // namespace

std::optional<RunConfiguration> recorded_configuration(const std::string& log) {
  EventLogReader reader(log);
  LogEvent event;
  // The prefix of the channels is itself part of the configuration, so that only the channel's
  // ending is compared.
  if (!reader.next(&event) || !event.channel.ends_with(name_of(Channel::kConfig))) {
    return std::nullopt;
  }
  return decode_run_configuration(event.data);
}

ReplayConfiguration choose_configuration(const std::string& log, const Arguments& arguments) {
  const auto recorded = recorded_configuration(log);
  const std::string recorded_name = recorded ? recorded->name + " as recorded in " + log : "";
  ReplayConfiguration chosen;
  if (has_configuration(arguments)) {
    chosen.config = load_configuration(arguments);
    chosen.origin = chosen.config.source.name;
  } else if (recorded) {
    refuse_preset(arguments.all("--set"));
    chosen.origin = recorded_name;
    chosen.config = load_recorded(*recorded, recorded_name, arguments.all("--set"));
  } else {
    throw UsageError("--config or --preset is required: " + log +
                     " holds no configuration (only leonavd's journals do)");
  }
  if (recorded) chosen.differences = compare(*recorded, recorded_name, chosen.config.source);
  return chosen;
}

}  // namespace leonav
