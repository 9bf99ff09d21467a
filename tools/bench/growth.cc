#include "tools/bench/growth.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "daemon/messages/input_dispatch.h"
#include "drivers/lcm/event_log.h"
#include "tools/bench/process_measures.h"
#include "tools/bench/timed_stages.h"

namespace leonav {
namespace {

constexpr double kFirstRow_s = 600.0, kRow_s = 3600.0, kEnd_s = 10.0;
// Differences within these factors may be chance: other satellites in view, other work on the
// machine.
constexpr double kMoreMemory = 1.02, kMoreTime = 1.25, kMoreOfWindow = 1.15;

struct Row {
  double hours = 0.0, resident_mb = 0.0, solve_ms = 0.0, slow_solve_ms = 0.0;
  std::size_t solves = 0;
  int keyframes = 0;
  double satellites = 0.0;                 // measurements in the window, per keyframe
  long unknowns = 0, residual_blocks = 0;  // in the window
};

Row row_of(double seconds, TimedStages* stages) {
  Row row;
  row.hours = seconds / 3600.0;
  row.resident_mb = memory_mb("VmRSS:");
  std::vector<double>& times = stages->solve.processor_s;
  if (times.empty()) throw std::runtime_error("the log gave the smoother no keyframe");
  row.solves = times.size();
  std::sort(times.begin(), times.end());
  row.solve_ms = 1e3 * quantile_below(times, 0.5);
  row.slow_solve_ms = 1e3 * quantile_below(times, 0.99);
  const Window& window = *stages->window();
  row.keyframes = window.size();
  row.residual_blocks = row.keyframes;  // the prior and the process factors
  for (int i = 0; i < window.size(); ++i) {
    row.satellites += static_cast<double>(window.at(i).satellites.size()) / window.size();
    row.unknowns += static_cast<long>(window.at(i).active.size());
    row.residual_blocks += static_cast<long>(window.at(i).measurements.size());
  }
  stages->forget();
  return row;
}

void print(const Row& row) {
  std::printf("%8.2f  %6zu  %9d  %10.1f  %8ld  %15ld  %9.3f  %9.3f  %8.1f\n", row.hours, row.solves,
              row.keyframes, row.satellites, row.unknowns, row.residual_blocks, row.solve_ms,
              row.slow_solve_ms, row.resident_mb);
  std::fflush(stdout);
}

// The sky changes from hour to hour, so that means of several rows are compared.
void require_no_growth(const std::vector<Row>& rows) {
  const auto count = std::min<std::ptrdiff_t>(6, std::ssize(rows) / 2);
  const auto require = [&](const char* what, auto value, double most) {
    double first = 0.0, last = 0.0;
    for (auto row = rows.begin(); row != rows.begin() + count; ++row)
      first += static_cast<double>(value(*row)) / static_cast<double>(count);
    for (auto row = rows.end() - count; row != rows.end(); ++row)
      last += static_cast<double>(value(*row)) / static_cast<double>(count);
    std::printf("%-24s first %.2f, last %.2f, at most %.2f times\n", what, first, last, most);
    if (!(last <= most * first)) throw std::runtime_error(std::string(what) + " has grown");
  };
  require(
      "resident megabytes", [](const Row& row) { return row.resident_mb; }, kMoreMemory);
  require(
      "keyframes", [](const Row& row) { return row.keyframes; }, 1.0);
  require(
      "unknowns", [](const Row& row) { return row.unknowns; }, kMoreOfWindow);
  require(
      "residual blocks", [](const Row& row) { return row.residual_blocks; }, kMoreOfWindow);
  require(
      "milliseconds of a solve", [](const Row& row) { return row.solve_ms; }, kMoreTime);
}

}  // namespace

void measure_growth(const NavigatorConfig& config, const std::string& log_path,
                    const std::string& prefix) {
  if (config.estimator != Estimator::kSmoother)
    throw std::runtime_error("growth is the smoother's: give --set estimator=smoother");
  TimedStages stages(config);
  stages.reserve();
  InputDispatch dispatch(stages.sequencer());
  EventLogReader reader(log_path);
  std::printf("%8s  %6s  %9s  %10s  %8s  %15s  %9s  %9s  %8s\n", "hours", "solves", "keyframes",
              "satellites", "unknowns", "residual blocks", "median ms", "99 % ms", "RSS, MB");
  LogEvent event;
  std::vector<Row> rows;
  std::int64_t first_us = -1;
  double next_s = kFirstRow_s, now_s = 0.0;
  while (reader.next(&event)) {
    const auto channel = channel_from_name(event.channel, prefix);
    if (!channel || !is_input(*channel)) continue;
    if (first_us < 0) first_us = event.timestamp_us;
    now_s = static_cast<double>(event.timestamp_us - first_us) * 1e-6;
    dispatch.dispatch(*channel, event.data);
    if (now_s < next_s) continue;
    rows.push_back(row_of(now_s, &stages));
    print(rows.back());
    next_s = rows.size() == 1 ? kRow_s : next_s + kRow_s;
  }
  if (now_s > next_s - kEnd_s) {  // the log's last hour is short by an epoch
    rows.push_back(row_of(now_s, &stages));
    print(rows.back());
  }
  if (rows.size() < 2) throw std::runtime_error(log_path + ": shorter than an hour");
  require_no_growth(rows);
}

}  // namespace leonav
