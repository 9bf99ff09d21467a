// leonav-bench measures how fast the navigator is on this machine, with a log that the user
// chooses.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/messages/input_dispatch.h"
#include "daemon/process/one_blas_thread.h"
#include "drivers/lcm/event_log.h"
#include "tools/bench/growth.h"
#include "tools/bench/process_measures.h"
#include "tools/bench/solver_comparison.h"
#include "tools/bench/timed_stages.h"
#include "tools/common/arguments.h"
#include "tools/common/configuration_options.h"

namespace {

using leonav::Times;

// OpenBLAS would have started its threads by main(): the service has one thread too.
__attribute__((section(".preinit_array"), used)) const auto kBeforeLibraries =
    leonav::start_with_one_blas_thread;

struct Message {
  leonav::Channel channel;
  std::vector<std::uint8_t> bytes;
};

struct Recording {
  std::vector<Message> messages;  // inputs only
  double span_s = 0.0;            // by the log's time stamps
};

Recording load(const std::string& path, const std::string& prefix) {
  Recording recording;
  leonav::EventLogReader reader(path);
  leonav::LogEvent event;
  std::int64_t first_us = 0, last_us = 0;
  while (reader.next(&event)) {
    const auto channel = leonav::channel_from_name(event.channel, prefix);
    if (!channel || !leonav::is_input(*channel)) continue;
    if (recording.messages.empty()) first_us = event.timestamp_us;
    last_us = event.timestamp_us;
    recording.messages.push_back({*channel, event.data});
  }
  if (recording.messages.empty()) {
    throw std::runtime_error(path + ": no input message on channels " + prefix +
                             "...; is it a leonav log?");
  }
  recording.span_s = static_cast<double>(last_us - first_us) * 1e-6;
  return recording;
}

// Prints one row of wall time and one of processor time; returns the 99 % quantile of the latter.
double print_rows(const char* name, const char* unit, double per_second, const Times& times) {
  double processor = 0.0;
  for (const bool wall : {true, false}) {
    std::vector<double> values = wall ? times.wall_s : times.processor_s;
    if (values.empty()) {
      std::printf("%-22s none\n", name);
      return 0.0;
    }
    for (double& value : values) value *= per_second;
    std::sort(values.begin(), values.end());
    std::printf("%-22s %8zu  median %9.3f  99 %% %9.3f  99.9 %% %9.3f  worst %9.3f %s\n",
                wall ? name : "  processor time", values.size(),
                leonav::quantile_below(values, 0.5), leonav::quantile_below(values, 0.99),
                leonav::quantile_below(values, 0.999), values.back(), unit);
    processor = leonav::quantile_below(values, 0.99);
  }
  return processor;
}

// Durations of all runs, and the counts of the last run: they are equal in all runs.
struct Bench {
  Times imu_sample, gnss_epoch, solve;
  std::vector<double> fastest_solve_s;  // processor time of each solve in its fastest run
  std::vector<double> speeds;
  std::vector<double> satellites;  // used in each epoch, sorted
  std::uint64_t carriers = 0, slips = 0;
  std::vector<double> iterations;  // of each solve, sorted
  int keyframes = 0;
  std::size_t solve_allocations = 0;  // of all runs
};

// All runs do the same work: what a solve's fastest one takes is free of most interruptions.
void keep_fastest(const std::vector<double>& run_s, std::vector<double>* fastest_s) {
  if (fastest_s->empty()) *fastest_s = run_s;
  if (fastest_s->size() != run_s.size())
    throw std::runtime_error("two runs differ in their solves");
  for (std::size_t i = 0; i < fastest_s->size(); ++i)
    (*fastest_s)[i] = std::min((*fastest_s)[i], run_s[i]);
}

// Returns the 99.9 % quantile over the median.
double print_fastest_solves(std::vector<double> fastest_s) {
  std::sort(fastest_s.begin(), fastest_s.end());
  const double median = 1e3 * leonav::quantile_below(fastest_s, 0.5);
  const double tail = 1e3 * leonav::quantile_below(fastest_s, 0.999);
  std::printf(
      "%-22s %8zu  median %9.3f  99 %% %9.3f  99.9 %% %9.3f  worst %9.3f ms, 99.9 %% over median "
      "%.2f\n",
      "  each at its fastest", fastest_s.size(), median,
      1e3 * leonav::quantile_below(fastest_s, 0.99), tail, 1e3 * fastest_s.back(), tail / median);
  return tail / median;
}

struct SolveTimes {
  double most_ms = 0.0;  // 99 % quantile, processor time
  double ratio = 0.0;    // 99.9 % quantile over the median, each solve at its fastest
};

SolveTimes print_solves(const Bench& bench) {
  SolveTimes times;
  times.most_ms = print_rows("solve", "ms", 1e3, bench.solve);
  times.ratio = print_fastest_solves(bench.fastest_solve_s);
  const double solves = static_cast<double>(bench.solve.wall_s.size());
  std::printf(
      "%-22s median %.0f, 99 %% %.0f, most %.0f; keyframes at most %d; allocations per solve "
      "%.3f\n",
      "  iterations", leonav::quantile_below(bench.iterations, 0.5),
      leonav::quantile_below(bench.iterations, 0.99), bench.iterations.back(), bench.keyframes,
      static_cast<double>(bench.solve_allocations) / solves);
  return times;
}

Bench run(const leonav::NavigatorConfig& config, const Recording& recording, int repeats) {
  Bench bench;
  for (int i = 0; i < repeats; ++i) {
    leonav::TimedStages stages(config);
    stages.reserve();
    leonav::InputDispatch dispatch(stages.sequencer());
    const auto start = std::chrono::steady_clock::now();
    for (const Message& message : recording.messages)
      dispatch.dispatch(message.channel, message.bytes);
    const auto end = std::chrono::steady_clock::now();
    bench.speeds.push_back(recording.span_s / std::chrono::duration<double>(end - start).count());
    bench.imu_sample.append(stages.imu_sample);
    bench.gnss_epoch.append(stages.gnss_epoch);
    bench.solve.append(stages.solve);
    keep_fastest(stages.solve.processor_s, &bench.fastest_solve_s);
    bench.solve_allocations += stages.solve_allocations;
    const leonav::CountingSink& sink = stages.sink();
    bench.satellites.assign(sink.satellites.begin(), sink.satellites.end());
    std::sort(bench.satellites.begin(), bench.satellites.end());
    bench.carriers = sink.carriers;
    bench.slips = sink.slips;
    bench.iterations.assign(sink.iterations.begin(), sink.iterations.end());
    std::sort(bench.iterations.begin(), bench.iterations.end());
    bench.keyframes = sink.keyframes;
    if (bench.satellites.empty()) throw std::runtime_error("the log gave no GNSS epoch");
    if (sink.solutions == 0 || bench.satellites.back() == 0.0) {
      throw std::runtime_error("nothing was navigated: " + std::to_string(sink.satellites.size()) +
                               " epochs, " + std::to_string(sink.solutions) +
                               " solutions, no satellite used; leonav-replay tells why");
    }
  }
  std::sort(bench.speeds.begin(), bench.speeds.end());
  return bench;
}

void require(const leonav::Arguments& arguments, const char* option, bool at_least, double value,
             const char* what) {
  if (!arguments.has(option)) return;
  const double limit = arguments.number(option);
  if (at_least ? value >= limit : value <= limit) return;
  throw std::runtime_error(std::string(what) + ": " + std::to_string(value) + ", but " + option +
                           " asks for at " + (at_least ? "least " : "most ") +
                           arguments.get(option));
}

int body(int argc, char** argv) {
  leonav::Arguments arguments(
      "leonav-bench", "--config vehicle.yaml [options] run.lcmlog",
      "Feeds a log's inputs through the navigator in one thread and prints "
      "microseconds per IMU sample,\n"
      "milliseconds per GNSS epoch and solve of the smoother, replay speed and peak memory.");
  leonav::add_configuration_options(&arguments);
  arguments.option("--repeat", "N", "runs over the log; times of all runs are pooled", "3")
      .option("--max-imu-us", "US",
              "fail unless 99 % of the IMU samples take at most so much processor time")
      .option("--max-epoch-ms", "MS", "the same of the GNSS epochs")
      .option("--max-solve-ms", "MS",
              "the same of the smoother's solves (--set estimator=smoother)")
      .option("--max-solve-ratio", "R",
              "fail unless 99.9 % of them, each at its fastest of all runs, take at most so many "
              "times the median")
      .flag("--growth",
            "instead: an hour's log or a day's once through the smoother; prints after ten minutes "
            "and every hour what it\n                   needs, and fails where that grows")
      .option("--solvers", "N",
              "instead: solve every N-th window of the smoother by its chain and by Ceres, compare "
              "minima and times of a step,\n                   and fail where they differ")
      .option("--min-satellites", "N", "fail unless half of the epochs use so many");
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() != 1) throw leonav::UsageError("give one log (--help)");
  const double repeats = arguments.number("--repeat");
  if (!(repeats >= 1.0 && repeats <= 1000.0)) {
    throw leonav::UsageError("--repeat must be 1 to 1000");
  }
  for (const char* limit : {"--max-imu-us", "--max-epoch-ms", "--max-solve-ms", "--max-solve-ratio",
                            "--min-satellites"}) {
    // an invalid value is refused before the long run
    if (arguments.has(limit)) arguments.number(limit);
  }
  const leonav::DaemonConfig config = leonav::load_configuration(arguments);
  if (arguments.has("--growth")) {
    leonav::measure_growth(config.navigator, arguments.positional()[0], config.lcm.prefix);
    return 0;
  }
  if (arguments.has("--solvers")) {
    const double every = arguments.number("--solvers");
    if (!(every >= 1.0 && every <= 1e6)) throw leonav::UsageError("--solvers must be 1 to 1000000");
    leonav::compare_solvers(config.navigator, arguments.positional()[0], config.lcm.prefix,
                            static_cast<int>(every));
    return 0;
  }
  const Recording recording = load(arguments.positional()[0], config.lcm.prefix);
  const Bench bench = run(config.navigator, recording, static_cast<int>(repeats));

  const double epochs = static_cast<double>(bench.satellites.size());
  const double satellites = leonav::quantile_below(bench.satellites, 0.5);
  std::printf("%zu inputs over %.1f s, %.0f runs\n", recording.messages.size(), recording.span_s,
              repeats);
  std::printf(
      "%-22s %8.0f  satellites used: median %.0f, most %.0f; carriers used %.1f, arcs "
      "ended %.2f per epoch\n",
      "epochs of a run", epochs, satellites, bench.satellites.back(),
      static_cast<double>(bench.carriers) / epochs, static_cast<double>(bench.slips) / epochs);
  const double imu_us = print_rows("IMU sample", "us", 1e6, bench.imu_sample);
  const double epoch_ms = print_rows("GNSS epoch", "ms", 1e3, bench.gnss_epoch);
  for (const std::string limit : {"--max-solve-ms", "--max-solve-ratio"})
    if (bench.iterations.empty() && arguments.has(limit))
      throw std::runtime_error(limit + ", but nothing was solved: --set estimator=smoother");
  const SolveTimes solves = bench.iterations.empty() ? SolveTimes() : print_solves(bench);
  std::printf("%-22s %.0f times real time (median run, decoding included)\n", "replay",
              bench.speeds[bench.speeds.size() / 2]);
  std::printf("%-22s %.1f MB, the log in memory included\n", "peak memory",
              leonav::memory_mb("VmHWM:"));
  require(arguments, "--min-satellites", true, satellites, "satellites used, median");
  require(arguments, "--max-imu-us", false, imu_us,
          "processor time of 99 % of the IMU samples, us");
  require(arguments, "--max-epoch-ms", false, epoch_ms,
          "processor time of 99 % of the GNSS epochs, ms");
  require(arguments, "--max-solve-ms", false, solves.most_ms,
          "processor time of 99 % of the solves, ms");
  require(arguments, "--max-solve-ratio", false, solves.ratio,
          "99.9 % of the solves, each at its fastest, over their median");
  if (bench.solve_allocations > 0) {
    throw std::runtime_error("the smoother has allocated memory " +
                             std::to_string(bench.solve_allocations) + " times");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-bench", body, argc, argv); }
