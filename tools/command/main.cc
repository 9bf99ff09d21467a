// leonav-command: sends a command to leonavd and prints the answer.
#include <iostream>
#include <numbers>
#include <optional>
#include <string>

#include "daemon/config/daemon_config.h"
#include "tools/command/command_sender.h"
#include "tools/common/arguments.h"

namespace {

using namespace leonav;

double degrees(const std::string& option, double value, double least, double most) {
  if (value >= least && value <= most) return value * std::numbers::pi / 180.0;
  throw UsageError(option + ": must be " + std::to_string(static_cast<int>(least)) + " to " +
                   std::to_string(static_cast<int>(most)) + " degrees");
}

Command command_of(const Arguments& arguments) {
  const auto& words = arguments.positional();
  if (words.size() != 1 || (words[0] != "restart" && words[0] != "heading"))
    throw UsageError("give one command, restart or heading (leonav-command --help)");
  const bool is_heading = words[0] == "heading";
  if (arguments.has("--degrees") != is_heading)
    throw UsageError("heading needs --degrees, and restart takes none");
  if (!is_heading && arguments.has("--sigma")) throw UsageError("restart takes no --sigma");
  if (!is_heading) return {};
  Command command;
  command.kind = CommandKind::kSetHeading;
  command.value = degrees("--degrees", arguments.number("--degrees"), 0.0, 360.0);
  command.sigma = degrees("--sigma", arguments.number("--sigma"), 0.0, 180.0);
  if (command.sigma <= 0.0) throw UsageError("--sigma: must be above 0");
  return command;
}

int run(int argc, char** argv) {
  const LcmConfig lcm;
  Arguments arguments(
      "leonav-command", "restart|heading [options]",
      "Sends a command to leonavd and prints the answer.\n"
      "\n"
      "  leonav-command restart                        drop the filter and align anew\n"
      "  leonav-command heading --degrees 87 --sigma 3 set the heading\n"
      "\n"
      "Where leonavd has a key (commands.key_file), give the same with --key-file: the command is\n"
      "then signed. docs/operations/commands.md says what that protects against.\n"
      "Exit codes: 0 done, 1 refused, not answered or not sent, 2 command line.");
  arguments.option("--degrees", "DEG", "heading, clockwise from north, 0 to 360")
      .option("--sigma", "DEG", "1 sigma of the heading", "5")
      .option("--key-file", "FILE", "sign with the key in FILE, one line, open to its owner only")
      .option("--lcm-url", "URL", "as lcm.url of leonavd", lcm.url)
      .option("--prefix", "TEXT", "beginning of channels, as lcm.prefix of leonavd", lcm.prefix)
      .option("--timeout", "S", "how long to wait for leonavd, and for its answer", "5");
  if (!arguments.parse(argc, argv)) return 0;
  const Command command = command_of(arguments);
  const double timeout_s = arguments.number("--timeout");
  if (!(timeout_s >= 0.1 && timeout_s <= 3600.0))
    throw UsageError("--timeout: must be 0.1 to 3600");
  std::optional<CommandKey> key;
  if (arguments.has("--key-file")) key = CommandKey::from_file(arguments.get("--key-file"));
  CommandSender sender(arguments.get("--lcm-url"), arguments.get("--prefix"), key);
  if (sender.send(command, timeout_s) == CommandResult::kDone) {
    std::cout << "done\n";
    return 0;
  }
  std::cout << "refused: the vehicle drives in another direction\n";
  return 1;
}

}  // namespace

int main(int argc, char** argv) { return run_tool("leonav-command", run, argc, argv); }
