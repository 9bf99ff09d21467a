// Embeds the navigator: prints the solution of an LCM log once a second. embed CONFIG.yaml LOG
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/navigator/navigator.h"
#include "daemon/config/load_config.h"
#include "daemon/messages/input_dispatch.h"
#include "drivers/lcm/event_log.h"

struct Printer final : leonav::OutputSink {
  void on_solution(const leonav::Solution& s) override {
    if (s.sequence % 200 != 1) return;
    const double deg = 180.0 / std::numbers::pi;
    std::printf("%.8f %.8f %.2f %s\n", s.latitude * deg, s.longitude * deg, s.height,
                std::string(to_string(s.source)).c_str());
  }
  void on_epoch(const leonav::EpochReport&) override {}
  void on_event(const leonav::Event&) override {}
  void on_decision(const leonav::Decision&) override {}
  void on_smoother(const leonav::SmootherReport&) override {}
};

int main(int argc, char** argv) try {
  if (argc != 3) throw std::runtime_error("usage: embed CONFIG.yaml LOG");
  const leonav::DaemonConfig config = leonav::load_config(argv[1]);
  Printer printer;
  leonav::Navigator navigator(config.navigator, &printer);
  leonav::InputDispatch inputs(&navigator.sequencer());
  leonav::EventLogReader log(argv[2]);
  for (leonav::LogEvent event; log.next(&event);) {
    const auto channel = leonav::channel_from_name(event.channel, config.lcm.prefix);
    if (channel && leonav::is_input(*channel)) inputs.dispatch(*channel, event.data);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "embed: %s\n", error.what());
  return 1;
}
