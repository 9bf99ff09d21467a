// leonav-starts makes cold starts at random instants of a recorded run and measures how soon, and
// how well, the heading is found.
#include <fstream>
#include <iostream>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_log.h"
#include "tools/common/arguments.h"
#include "tools/common/configuration_options.h"
#include "tools/common/progress_bar.h"
#include "tools/starts/cold_starts.h"
#include "tools/starts/start_list.h"
#include "tools/starts/start_tables.h"

namespace {

using namespace leonav;

constexpr int kWrong = 3;  // exit code

Arguments declare() {
  Arguments arguments(
      "leonav-starts", "--config FILE --truth truth.csv [options] run.lcmlog",
      "Starts the navigator at random instants of a recorded run, each time knowing "
      "nothing but its\nconfiguration and the satellites' orbits, and prints how soon "
      "and how well it finds its heading:\nstanding, straight on, in a curve and (at some time) "
      "in reverse, by the first ten seconds. Exit codes: 0 no false alignment;\n1 a file cannot be "
      "used; 2 command line; 3 a heading was wrong: an alignment false, carried away later, or\n"
      "(--told-off) still wrong at the end.");
  add_configuration_options(&arguments);
  arguments.option("--truth", "FILE", "truth.csv with velocity and attitude")
      .option("--number", "N", "starts of each kind, as far as the run has so many", "100")
      .option("--seconds", "S", "length of each", "60")
      .option("--seed", "N", "of the instants", "1")
      .option("--told-off", "LOW:HIGH",
              "each start is told a heading that is off by so many degrees, to either side; prints "
              "how soon that is found")
      .option("--list", "FILE", "a row per start, as CSV");
  return arguments;
}

// Draws the heading errors of `number` starts, rad; empty if no heading is given.
std::vector<double> draw_told(const std::string& range, std::size_t number, std::uint64_t seed) {
  std::vector<double> told;
  if (range.empty()) return told;
  double low = 0.0, high = 0.0;
  char colon = 0;
  std::istringstream in(range);
  if (!(in >> low >> colon >> high) || colon != ':' || !(in >> std::ws).eof() ||
      !(low >= 0.0 && low <= high && high <= 180.0))
    throw UsageError("--told-off: expected LOW:HIGH, degrees from 0 to 180");
  std::mt19937_64 bits(seed + 1);
  while (told.size() < number) {
    const double share = static_cast<double>(bits() >> 11) * 0x1p-53;
    const double side = (bits() & 1) != 0 ? 1.0 : -1.0;
    told.push_back(side * (low + share * (high - low)) * std::numbers::pi / 180.0);
  }
  return told;
}

// The file is opened before the run, so that a missing folder does not cost the run.
std::ofstream opened(const std::string& path) {
  std::ofstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be written");
  return file;
}

int run(int argc, char** argv) {
  Arguments arguments = declare();
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() != 1) throw UsageError("expected one log file");
  const double number = arguments.number("--number"), seconds = arguments.number("--seconds");
  if (!(number >= 1.0 && number <= 10'000.0)) throw UsageError("--number: must be 1 to 10000");
  if (!(seconds >= 31.0 && seconds <= 3600.0)) throw UsageError("--seconds: must be 31 to 3600");
  const double seed = arguments.number("--seed");
  if (!(seed >= 0.0 && seed <= 1e15)) throw UsageError("--seed: must be 0 to 1e15");
  const DaemonConfig config = load_configuration(arguments);
  if (config.navigator.motion != MotionModel::kInertial)
    throw std::runtime_error("ekf.motion is not inertial: there is no heading to be found");
  std::ofstream list;
  if (arguments.has("--list")) list = opened(arguments.get("--list"));
  const Track truth = load_truth(arguments.required("--truth"));
  const auto whole_seed = static_cast<std::uint64_t>(seed);
  std::vector<GpsTime> instants =
      choose_starts(truth, static_cast<int>(number), seconds, whole_seed);
  const std::string range = arguments.has("--told-off") ? arguments.get("--told-off") : "";
  std::vector<double> told = draw_told(range, instants.size(), whole_seed);
  ColdStarts starts(config.navigator, truth, std::move(instants), std::move(told), seconds);
  EventLogReader log(arguments.positional().front());
  LogEvent event;
  ProgressBar progress(&std::cerr, "leonav-starts", is_stderr_terminal());
  while (log.next(&event)) {
    progress.show(static_cast<double>(log.position_bytes()) /
                  static_cast<double>(log.size_bytes()));
    const auto channel = channel_from_name(event.channel, config.lcm.prefix);
    if (channel && is_input(*channel)) starts.take(*channel, event.data);
  }
  const std::vector<StartResult> results = starts.finish();
  if (results.empty())
    throw std::runtime_error(
        "no start was made: is the truth of this log, with velocity and attitude?");
  const int wrong = range.empty() ? print_table(results, std::cout)
                                  : print_given_heading_table(results, std::cout);
  if (starts.not_begun() + starts.cut_short() > 0)
    std::cout << "the log ends before the truth: " << starts.not_begun()
              << " starts after its end were not made, " << starts.cut_short()
              << " are shorter than the others\n";
  if (arguments.has("--list")) {
    write_start_list(results, list);
    list.close();
    if (!list) throw std::runtime_error(arguments.get("--list") + ": cannot be written");
  }
  if (wrong == 0) return 0;
  std::cerr << "leonav-starts: " << wrong << " of " << results.size()
            << " starts had a wrong heading\n";
  return kWrong;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-starts", run, argc, argv); }
