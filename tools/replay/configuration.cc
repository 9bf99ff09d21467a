#include "configuration.h"

#include "daemon/config/load_config.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_log.h"
#include "tools/common/arguments.h"

namespace leonav {
namespace {

constexpr const char* kThisProgram = "leonavd " LEONAV_VERSION;

// Without the overrides that cannot change an answer.
std::vector<std::string> navigation_only(std::vector<std::string> overrides) {
  std::erase_if(overrides, [](const std::string& one) {
    return one.starts_with("lcm.url=") || one.starts_with("journal.");
  });
  return overrides;
}

std::string compare(const RunConfiguration& recorded, const ConfigText& used) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  if (recorded.text != used.text) {
    add("the journal was written with another text of configuration (" + recorded.name + ")");
  }
  const auto recorded_overrides = navigation_only(recorded.overrides);
  if (recorded_overrides != navigation_only(used.overrides)) {
    std::string list;
    for (const std::string& one : recorded_overrides) list += " --set " + one;
    add("the journal was written with" + (list.empty() ? std::string(" no --set") : list));
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
  // The prefix of the channels is itself part of the configuration.
  if (!reader.next(&event) || !event.channel.ends_with(name_of(Channel::kConfig))) {
    return std::nullopt;
  }
  return decode_run_configuration(event.data);
}

ReplayConfiguration choose_configuration(const std::string& log,
                                         const std::optional<std::string>& file,
                                         const std::vector<std::string>& overrides) {
  const auto recorded = recorded_configuration(log);
  ReplayConfiguration chosen;
  if (file) {
    chosen.config = load_config(*file, overrides);
    chosen.origin = *file;
  } else if (recorded) {
    std::vector<std::string> all = recorded->overrides;
    all.insert(all.end(), overrides.begin(), overrides.end());
    chosen.origin = recorded->name + " as recorded in " + log;
    chosen.config = load_config_text(recorded->text, chosen.origin, all);
  } else {
    throw UsageError("--config is required: " + log +
                     " holds no configuration (only leonavd's journals do)");
  }
  if (recorded) chosen.differences = compare(*recorded, chosen.config.source);
  return chosen;
}

}  // namespace leonav
