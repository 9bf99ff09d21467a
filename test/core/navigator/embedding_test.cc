// The shortest program that embeds the navigator, by the one header for it.
#include "core/navigator/navigator.h"

#include "support/catch.h"
#include "support/sky/simulated_sky.h"

using namespace leonav;

namespace {

struct CountingSink final : OutputSink {
  int epochs = 0, miss_events = 0, commits = 0, misses = 0;
  Solution last;
  void on_solution(const Solution& solution) override { last = solution; }
  void on_epoch(const EpochReport&) override { ++epochs; }
  void on_event(const Event& event) override {
    miss_events += event.kind == EventKind::kDeadlineMiss ? 1 : 0;
  }
  void on_decision(const Decision& decision) override { ++(decision.committed ? commits : misses); }
  void on_smoother(const SmootherReport&) override {}
};

// An IMU and a receiver at rest under the satellites of two systems.
void feed(int seconds, Sequencer* inputs) {
  const GpsTime start = test::kSkyEpoch;
  test::SimulatedSky sky;
  sky.add(test::gps_walker());
  sky.add(test::galileo_walker());
  for (const Ephemeris& ephemeris : sky.ephemerides) inputs->on_ephemeris(ephemeris);
  for (int i = 1; i <= 100 * seconds; ++i) {
    ImuSample sample;
    sample.time = start.plus_nanoseconds(i * 10'000'000LL);
    sample.interval_ns = 10'000'000;
    sample.delta_velocity_b << 0.0, 0.0, -9.8 * sample.interval_s();
    inputs->on_imu(sample);
    if (i % 100 != 0) continue;
    inputs->on_raw_epoch(test::simulate_epoch(sky, test::SimulatedReceiver{}, i / 100));
  }
}

}  // namespace

TEST_CASE("one header embeds the navigator: a configuration, inputs, a sink") {
  NavigatorConfig config = default_navigator_config(VehicleKind::kCar);
  config.vehicle.lever_arm_b = {0.3, 0.0, -1.2};
  CountingSink sink;
  Navigator navigator(config, &sink);
  feed(5, &navigator.sequencer());
  CHECK(sink.epochs == 5);
  CHECK(sink.commits == 4);  // the last epoch's deadline is not reached
  CHECK(sink.misses == 0);
  CHECK(sink.last.source == Source::kAligning);  // at rest it has no heading yet
  CHECK((sink.last.p_e - test::SimulatedReceiver{}.p_e).norm() < 5.0);
}

TEST_CASE("a recorded miss is replayed as one, with its event") {
  CountingSink sink;
  Navigator navigator(default_navigator_config(VehicleKind::kCar), &sink);
  Decision missed;
  missed.epoch = 2;
  navigator.record(missed);
  feed(5, &navigator.sequencer());
  CHECK(sink.commits == 3);
  CHECK(sink.misses == 1);
  CHECK(sink.miss_events == 1);
}
