// leonav-starts: cold starts at random instants of a recorded run; how soon, and how well, the
// heading is found.
#include <algorithm>
#include <array>
#include <deque>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "daemon/config/load_config.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_log.h"
#include "start.h"
#include "table.h"
#include "tools/common/arguments.h"
#include "tools/common/progress_bar.h"

namespace {

using namespace leonav;

Arguments declare() {
  Arguments arguments(
      "leonav-starts", "--config FILE --truth truth.csv [options] run.lcmlog",
      "Starts the navigator at random instants of a recorded run, each time knowing "
      "nothing but its\nconfiguration and the satellites' orbits, and prints how soon "
      "and how well it finds its heading:\nstanding, straight on, in a curve and (at some time) "
      "in reverse, by the first ten seconds. Exit codes: 0 no false alignment;\n1 a file cannot be "
      "used, "
      "or alignments were false (beyond 5 degrees and five of their sigmas);\n2 command "
      "line.");
  arguments.option("--config", "FILE", "configuration, as for leonavd")
      .option("--truth", "FILE", "truth.csv with velocity and attitude")
      .option("--number", "N", "starts of each kind, as far as the run has so many", "100")
      .option("--seconds", "S", "length of each", "60")
      .option("--seed", "N", "of the instants", "1")
      .option("--told-off", "LOW:HIGH",
              "each start is told a heading that is off by so many degrees, to either side; prints "
              "how soon that is found")
      .option("--list", "FILE", "a row per start, as CSV")
      .option("--set", "KEY=VALUE", "override one configuration key; may be repeated");
  return arguments;
}

// Instants of the four kinds, in order of time.
std::vector<GpsTime> choose(const Track& truth, int number, double seconds, std::uint64_t seed) {
  std::vector<GpsTime> chosen;
  std::mt19937_64 bits(seed);
  const double whole = seconds_between(truth.back().time, truth.front().time) - seconds;
  if (!(whole > 0.0)) throw std::runtime_error("the truth is shorter than a start's length");
  std::array<int, 4> missing;
  missing.fill(number);
  // Milliseconds, so that no start knows of the epochs' seconds.
  for (int tried = 0; tried < 1000 * number; ++tried) {
    const auto ms = static_cast<std::int64_t>(bits() % static_cast<std::uint64_t>(1e3 * whole));
    const GpsTime start = truth.front().time.plus_nanoseconds(ms * 1'000'000);
    const Way way = way_at(truth, start);
    if (way == Way::kOther || missing[static_cast<std::size_t>(way)] == 0) continue;
    --missing[static_cast<std::size_t>(way)];
    chosen.push_back(start);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

// The starts that are under way while the log is read once.
class Starts {
 public:
  // `told_off`: index-parallel to `instants`, or empty: nothing is told.
  Starts(const NavigatorConfig& config, const Track& truth, std::vector<GpsTime> instants,
         std::vector<double> told_off, double seconds)
      : config_(config),
        truth_(truth),
        instants_(std::move(instants)),
        told_off_(std::move(told_off)),
        seconds_(seconds) {}

  void take(Channel channel, const std::vector<std::uint8_t>& data) {
    if (is_product(channel)) products_.push_back({channel, data});
    ImuSample sample;
    if (channel == Channel::kImu && decoder_.decode(data, &sample).fault == InputFault::kNone)
      move_to(sample.time);
    for (const auto& start : under_way_) start->dispatch(channel, data);
  }
  std::vector<StartResult> finish() {
    while (!under_way_.empty()) end_first();
    return std::move(results_);
  }

 private:
  void move_to(GpsTime now) {
    while (!under_way_.empty() && now > under_way_.front()->result().start.plus_seconds(seconds_))
      end_first();
    for (; next_ < instants_.size() && instants_[next_] <= now; ++next_) {
      const auto told = told_off_.empty() ? std::nullopt : std::optional(told_off_[next_]);
      under_way_.push_back(
          std::make_unique<Start>(config_, truth_, instants_[next_], products_, told));
    }
  }
  void end_first() {
    results_.push_back(under_way_.front()->result());
    under_way_.pop_front();
  }

  const NavigatorConfig& config_;
  const Track& truth_;
  std::vector<GpsTime> instants_;
  std::vector<double> told_off_;
  double seconds_;
  std::size_t next_ = 0;
  Decoder decoder_;
  std::vector<Product> products_;
  std::deque<std::unique_ptr<Start>> under_way_;
  std::vector<StartResult> results_;
};

// rad, of `number` starts; empty: none is told.
std::vector<double> draw_told(const std::string& range, std::size_t number, std::uint64_t seed) {
  std::vector<double> told;
  if (range.empty()) return told;
  double low = 0.0, high = 0.0;
  char colon = 0;
  std::istringstream in(range);
  if (!(in >> low >> colon >> high) || colon != ':' ||
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

void write_list(const std::string& path, const std::vector<StartResult>& results) {
  std::ofstream file(path);
  file << "gps_tow_s,way,aligned_after_s,heading_error_deg,heading_sigma_deg,error_at_30_s_deg,"
          "sigma_at_30_s_deg,false,told_off_deg,restarts,noticed_after_s,error_when_noticed_deg,"
          "driven_s,error_at_end_deg,"
          "sigma_at_end_deg\n";
  constexpr double kDegree = std::numbers::pi / 180.0;
  for (const StartResult& r : results) {
    file << std::fixed << std::setprecision(3) << r.start.tow_s() << ',' << to_string(r.way) << ','
         << r.aligned_after_s << ',' << r.error_when_aligned / kDegree << ','
         << r.sigma_when_aligned / kDegree << ',';
    if (r.error_at_30_s)
      file << *r.error_at_30_s / kDegree << ',' << r.sigma_at_30_s / kDegree;
    else
      file << ',';
    file << ',' << (is_false(r) ? 1 : 0) << ',' << r.told_off.value_or(0.0) / kDegree << ','
         << r.restarts << ',' << r.noticed_after_s << ',' << r.error_when_noticed / kDegree << ','
         << r.driven_s << ',';
    if (r.error_at_end) file << *r.error_at_end / kDegree;
    file << ',' << r.sigma_at_end / kDegree << '\n';
  }
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot be written");
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
  const DaemonConfig config = load_config(arguments.required("--config"), arguments.all("--set"));
  if (config.navigator.motion != MotionModel::kInertial)
    throw std::runtime_error("ekf.motion is not inertial: there is no heading to be found");
  const Track truth = load_truth(arguments.required("--truth"));
  const auto whole_seed = static_cast<std::uint64_t>(seed);
  std::vector<GpsTime> instants = choose(truth, static_cast<int>(number), seconds, whole_seed);
  const std::string range = arguments.has("--told-off") ? arguments.get("--told-off") : "";
  std::vector<double> told = draw_told(range, instants.size(), whole_seed);
  Starts starts(config.navigator, truth, std::move(instants), std::move(told), seconds);
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
  const int wrong =
      range.empty() ? print_table(results, std::cout) : print_told_table(results, std::cout);
  if (arguments.has("--list")) write_list(arguments.get("--list"), results);
  if (wrong > 0) throw std::runtime_error(std::to_string(wrong) + " false alignments");
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-starts", run, argc, argv); }
