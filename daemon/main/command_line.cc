#include "daemon/main/command_line.h"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <vector>

#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "daemon/config/presets.h"
#include "daemon/health/health_reason.h"
#include "daemon/journal/journal_check.h"
#include "daemon/main/configured_gate.h"
#include "daemon/text/events_document.h"
#include "tools/common/configuration_options.h"

namespace leonav {

CommandLine::CommandLine()
    : arguments_(
          "leonavd", "--config FILE [options]\n       leonavd --check [--config] FILE [options]",
          "The navigation daemon: takes IMU and GNSS from LCM, publishes position, velocity and "
          "attitude.\n"
          "SIGTERM and SIGINT end it cleanly, with the journal complete; a second one at once.\n"
          "SIGHUP reads the configuration again: the log says of each changed key whether it is "
          "in effect\n"
          "(journal.outputs, flush_interval_s, piece_mb, piece_s, total_mb, kept_mb; log.level) or "
          "needs a restart.\n"
          "The key for commands (commands.key_file) is read again too.\n"
          "Exit codes: 0 stopped cleanly, 1 failure while running, 2 command line, 3 "
          "configuration, 4 LCM, 5 journal.") {
  add_configuration_options(&arguments_);
  arguments_.option("--lcm-url", "URL", "instead of lcm.url")
      .option("--journal", "FILE",
              "instead of journal.path; an LCM log that replays bit for bit; a file "
              "that exists is kept, and FILE.1, FILE.2, ... written")
      .flag("--check",
            "run nothing: print the effective value of every key and where it is from, or what is "
            "wrong")
      .flag("--changes", "with --check: print only the keys that differ from the defaults")
      .flag("--reference", "print every key with its default, its range and its meaning")
      .flag("--reasons", "print every reason of HEALTH with what to do, as a table in Markdown")
      .flag("--events", "print every kind of event with its code and value, as tables in Markdown");
}

bool CommandLine::asks_for_run(int argc, char** argv) {
  if (!arguments_.parse(argc, argv)) return false;
  if (arguments_.has("--reference")) {
    std::cout << reference_text();
    return false;
  }
  if (arguments_.has("--reasons")) {
    std::cout << health_reasons_as_markdown();
    return false;
  }
  if (arguments_.has("--events")) {
    std::cout << events_as_markdown();
    return false;
  }
  const bool checks = arguments_.has("--check");
  if (checks && arguments_.positional().size() == 1) arguments_.take_positional_as("--config");
  if (!arguments_.positional().empty()) {
    throw UsageError("unexpected argument '" + arguments_.positional().front() +
                     "' (leonavd --help)");
  }
  if (arguments_.has("--changes") && !checks) throw UsageError("--changes goes with --check");
  if (checks) print_configuration();
  return !checks;
}

std::vector<std::string> CommandLine::overrides() const {
  std::vector<std::string> overrides;
  if (arguments_.has("--lcm-url")) {
    overrides.push_back(text_override("lcm.url", arguments_.get("--lcm-url")));
  }
  if (arguments_.has("--journal")) {
    overrides.push_back(text_override("journal.path", arguments_.get("--journal")));
  }
  return overrides;
}

RunConfiguration CommandLine::load() const {
  RunConfiguration run;
  const auto make_gate = [&run](const DaemonConfig& config) { run.gate = configured_gate(config); };
  run.config = load_configuration(arguments_, overrides(), {require_journal, make_gate});
  return run;
}

DaemonConfig CommandLine::load_again() const {
  const std::string file = arguments_.has("--config") ? arguments_.get("--config") : "";
  std::error_code error;
  if (!file.empty() && !std::filesystem::is_regular_file(file, error))
    throw ConfigError(file + ": is no file that can be read again; restart leonavd");
  return load_configuration(arguments_, overrides(), {require_journal});
}

void CommandLine::print_configuration() const {
  const DaemonConfig config = load().config;
  const bool changes = arguments_.has("--changes");
  std::cout << effective_text(config.source, changes ? Extent::kChanges : Extent::kAllKeys);
  spdlog::info("{}: good", config.source.name);
}

}  // namespace leonav
