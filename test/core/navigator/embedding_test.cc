// The shortest program that embeds the navigator, by the one header for it.
#include "core/navigator/navigator.h"

#include "support/catch.h"

using namespace leonav;

namespace {

struct CountingSink final : OutputSink {
  int epochs = 0, events = 0, commits = 0, misses = 0;
  void on_solution(const Solution&) override {}
  void on_epoch(const EpochReport&) override { ++epochs; }
  void on_event(const Event&) override { ++events; }
  void on_decision(const Decision& decision) override { ++(decision.committed ? commits : misses); }
  void on_smoother(const SmootherReport&) override {}
};

// An IMU at rest, and a receiver without a signal.
void feed(int seconds, Sequencer* inputs) {
  const GpsTime start = GpsTime::from_week_and_tow(2200, 100'000.0);
  for (int i = 1; i <= 100 * seconds; ++i) {
    ImuSample sample;
    sample.time = start.plus_nanoseconds(i * 10'000'000LL);
    sample.interval_ns = 10'000'000;
    sample.delta_velocity_b << 0.0, 0.0, -9.8 * sample.interval_s();
    inputs->on_imu(sample);
    if (i % 100 != 0) continue;
    RawEpoch epoch;
    epoch.time = sample.time;
    inputs->on_raw_epoch(epoch);
  }
}

}  // namespace

TEST_CASE("one header embeds the navigator: a configuration, inputs, a sink") {
  NavigatorConfig config;
  config.vehicle.lever_arm_b = {0.3, 0.0, -1.2};
  CountingSink sink;
  Navigator navigator(config, &sink);
  feed(5, &navigator.sequencer());
  CHECK(sink.epochs == 5);
  CHECK(sink.commits == 4);  // the last epoch's deadline is not reached
  CHECK(sink.misses == 0);
}

TEST_CASE("a recorded miss is replayed as one, with its event") {
  CountingSink sink;
  Navigator navigator(NavigatorConfig(), &sink);
  Decision missed;
  missed.epoch = 2;
  navigator.record(missed);
  feed(5, &navigator.sequencer());
  CHECK(sink.commits == 3);
  CHECK(sink.misses == 1);
  CHECK(sink.events == 1);
}
