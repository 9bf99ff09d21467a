// leonav-bench: how fast the navigator is on this machine, on a log of the user's choice.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/config/load_config.h"
#include "daemon/input_dispatch.h"
#include "drivers/lcm/event_log.h"
#include "timed_stages.h"
#include "tools/common/arguments.h"

namespace {

using Clock = std::chrono::steady_clock;

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

void print_row(const char* name, const char* unit, std::vector<double> values) {
  if (values.empty()) {
    std::printf("%-22s none\n", name);
    return;
  }
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  std::printf("%-22s %8zu  median %9.3f  99 %% %9.3f  99.9 %% %9.3f  worst %9.3f %s\n", name,
              values.size(), at(0.5), at(0.99), at(0.999), values.back(), unit);
}

double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    double kilobytes = 0.0;
    if (word == "VmHWM:" && status >> kilobytes) return kilobytes / 1024.0;
  }
  return 0.0;
}

int body(int argc, char** argv) {
  leonav::Arguments arguments("leonav-bench", "--config vehicle.yaml [options] run.lcmlog",
                              "Feeds a log's inputs through the navigator in one thread and prints "
                              "microseconds per IMU sample,\n"
                              "milliseconds per GNSS epoch, replay speed and peak memory.");
  arguments.option("--config", "FILE", "the vehicle's configuration")
      .option("--set", "GROUP.KEY=VALUE", "override one key of it; may be repeated")
      .option("--repeat", "N", "runs over the log; times of all runs are pooled", "3");
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() != 1) throw leonav::UsageError("give one log (--help)");
  const int repeats = static_cast<int>(arguments.number("--repeat"));
  if (repeats < 1) throw leonav::UsageError("--repeat must be at least 1");

  const leonav::DaemonConfig config =
      leonav::load_config(arguments.required("--config"), arguments.all("--set"));
  const Recording recording = load(arguments.positional()[0], config.lcm.prefix);

  std::vector<double> imu_us, epoch_ms, speeds;
  std::uint64_t epochs = 0, satellites = 0, solutions = 0;
  for (int i = 0; i < repeats; ++i) {
    leonav::TimedStages stages(config.navigator);
    stages.imu_sample_us.reserve(recording.messages.size());
    leonav::InputDispatch dispatch(stages.sequencer());
    const Clock::time_point start = Clock::now();
    for (const Message& message : recording.messages)
      dispatch.dispatch(message.channel, message.bytes);
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
    speeds.push_back(recording.span_s / elapsed_s);
    imu_us.insert(imu_us.end(), stages.imu_sample_us.begin(), stages.imu_sample_us.end());
    epoch_ms.insert(epoch_ms.end(), stages.gnss_epoch_ms.begin(), stages.gnss_epoch_ms.end());
    epochs = stages.sink().epochs;
    satellites = stages.sink().satellites;
    solutions = stages.sink().solutions;
  }
  if (epochs == 0) throw std::runtime_error("the log gave no GNSS epoch");
  if (solutions == 0 || satellites == 0) {
    throw std::runtime_error("nothing was navigated: " + std::to_string(epochs) + " epochs, " +
                             std::to_string(satellites) + " satellites used, " +
                             std::to_string(solutions) + " solutions; leonav-replay tells why");
  }
  std::printf("%zu inputs over %.1f s, %d runs, %.1f satellites used per epoch\n",
              recording.messages.size(), recording.span_s, repeats,
              static_cast<double>(satellites) / static_cast<double>(epochs));
  print_row("IMU sample", "us", imu_us);
  print_row("GNSS epoch", "ms", epoch_ms);
  std::sort(speeds.begin(), speeds.end());
  std::printf("%-22s %.0f times real time (median run, decoding included)\n", "replay",
              speeds[speeds.size() / 2]);
  std::printf("%-22s %.1f MB, the log in memory included\n", "peak memory", peak_memory_mb());
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-bench", body, argc, argv); }
