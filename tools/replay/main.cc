// leonav-replay runs a recorded log through the navigator, in one thread and as fast as possible.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "daemon/config/effective_config.h"
#include "tools/common/configuration_options.h"
#include "tools/replay/configuration.h"
#include "tools/replay/journal_scan.h"
#include "tools/replay/replay_run.h"
#include "tools/replay/result_files.h"

namespace {

using namespace leonav;

constexpr const char* kCutShort = ": its last message is cut short; replaying what is whole\n";

Arguments declare() {
  Arguments arguments(
      "leonav-replay", "[--config FILE | --preset NAME] --out DIR [options] run.lcmlog",
      "Feeds an LCM log (of lcm-logger, leonav-import or leonavd's journal) to the "
      "navigator and writes\nits answers as tables. The first piece of a journal stands for all "
      "its "
      "pieces, and so does their folder. A journal holds its own configuration, which "
      "is the "
      "default. Its deadline misses are\nobeyed, so that its run comes again bit for bit.\nExit "
      "codes: 0 done; 1 a file or the "
      "configuration cannot be used, the log gave no answer, or --verify found a\ndifference (what "
      "tables there are and summary.txt are written even so); 2 command line.");
  add_configuration_options(&arguments);
  arguments
      .option("--out", "DIR",
              "folder for solution.csv, epochs.csv, satellites.csv, "
              "measurements.csv, events.csv, summary.txt and configuration.yaml")
      .option("--rate", "HZ",
              "rows of solution.csv from the continuous solution at this rate "
              "instead of one per epoch")
      .flag("--verify", "compare every output with those in the journal, byte for byte")
      .flag("--columns", "print the columns of every table and exit");
  return arguments;
}

std::optional<double> rate_of(const Arguments& arguments) {
  if (!arguments.has("--rate")) return std::nullopt;
  const double rate = arguments.number("--rate");
  if (!(rate >= 0.001 && rate <= 1000.0)) throw UsageError("--rate: must be 0.001 to 1000 Hz");
  return rate;
}

void require_inputs(const JournalScan& scan, const std::string& log, const std::string& prefix) {
  if (scan.inputs() > 0) return;
  throw std::runtime_error(log + ": no inputs on channels " + prefix + "* (" +
                           std::to_string(scan.other_messages) +
                           " messages on others); is lcm.prefix right?");
}

// Returns why the log gave no useful result; empty if it gave one. Tables alone are no proof:
// without an IMU the inertial configuration still fills them from the filter, but there is no
// SOLUTION.
std::string no_answer(const ReplayRun& run, const JournalScan& scan, bool inertial) {
  const std::string inputs = " (" + scan.describe() + ")";
  if (scan.messages[index_of(Channel::kGnssEpoch)] == 0) {
    return "no position without GNSS: the log has no GNSS_EPOCH" + inputs;
  }
  if (inertial && scan.messages[index_of(Channel::kImu)] == 0) {
    return "ekf.motion is inertial, but the log has no IMU" + inputs +
           "; use --set ekf.motion=constant_velocity";
  }
  if (run.statistics().solutions() == 0 && run.statistics().epochs() == 0) {
    return "the log gave no solution and no epoch: " + scan.describe();
  }
  if (run.statistics().solutions() == 0 || run.solution_rows() == 0) {
    return "no position was found; see summary.txt for the satellites' reasons" + inputs;
  }
  return "";
}

// Returns what went wrong; empty if nothing did.
std::string verdict(const ReplayRun& run, const JournalScan& scan, bool inertial,
                    const std::string& other_run, std::ostream& out) {
  if (const Verifier* verifier = run.verifier()) {
    if (!scan.is_journal()) {
      return "nothing to verify: the log is no journal of leonavd (it holds no DECISION)";
    }
    out << "verified " << verifier->compared() << " outputs, " << verifier->differences()
        << " differences\n";
    if (verifier->unrecorded() > 0) {
      out << "not in the journal, and so not compared: " << verifier->unrecorded() << " outputs\n";
    }
    if (scan.is_broken()) {
      out << "the journal has messages missing; regenerated behind the first of them: "
          << verifier->beyond_end() << "\n";
    } else if (!scan.stopped_cleanly) {
      out << "the journal was cut; regenerated beyond its end: " << verifier->beyond_end() << "\n";
    }
    if (verifier->differences() > 0) {
      return "the replay differs from the journal: " + verifier->first_difference() +
             (other_run.empty() ? "" : "; " + other_run);
    }
    if (verifier->compared() == 0 && scan.is_broken())
      return "nothing to verify: the journal lacks the beginning of its run";
    if (verifier->compared() == 0) return "nothing to verify: the log holds no recorded outputs";
  }
  return no_answer(run, scan, inertial);
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
}

int replay(int argc, char** argv) {
  Arguments arguments = declare();
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.has("--columns")) {
    std::cout << table_columns();
    return 0;
  }
  if (arguments.positional().size() != 1)
    throw UsageError("expected one log, or one folder with the pieces of a journal");
  ReplayRun::Options options;
  options.log = arguments.positional().front();
  options.out_folder = arguments.required("--out");
  options.rate_hz = rate_of(arguments);
  options.verify = arguments.has("--verify");
  const auto [config, origin, other_run] = choose_configuration(options.log, arguments);

  const JournalScan scan = scan_journal(options.log, config.lcm.prefix);
  require_inputs(scan, options.log, config.lcm.prefix);
  if (scan.truncated) {
    std::cerr << "leonav-replay: " << options.log << kCutShort;
  }
  std::filesystem::create_directories(options.out_folder);
  write_text(options.out_folder + "/configuration.yaml", effective_text(config.source));
  ReplayRun run(config, options, scan);
  run.run();

  std::ostringstream summary;
  summary << "configuration: " << origin << "\n";
  if (!other_run.empty()) summary << "note: " << other_run << "\n";
  if (scan.truncated) summary << "warning: " << options.log << kCutShort;
  run.print_summary(summary);
  std::vector<std::string> warnings = scan.losses();
  for (std::string& one : run.warnings()) warnings.push_back(std::move(one));
  for (const std::string& warning : warnings) {
    summary << "warning: " << warning << "\n";
    std::cerr << "leonav-replay: WARNING: " << warning << "\n";
  }
  const bool inertial = config.navigator.motion == MotionModel::kInertial;
  const std::string failure = verdict(run, scan, inertial, other_run, summary);
  if (!failure.empty()) summary << "failure: " << failure << "\n";
  std::cout << summary.str();
  write_text(options.out_folder + "/summary.txt", summary.str());
  if (!failure.empty()) throw std::runtime_error(failure);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-replay", replay, argc, argv); }
