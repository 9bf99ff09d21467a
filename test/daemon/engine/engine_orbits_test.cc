// A message of precise orbits while the GNSS stage is busy.
#include <atomic>
#include <thread>
#include <vector>

#include "daemon/engine/engine.h"
#include "engine_runs.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;

// States of `count` LEO satellites, all good.
std::vector<PreciseState> states_of(int count) {
  std::vector<PreciseState> states;
  for (int i = 1; i <= count; ++i) {
    PreciseState state;
    state.satellite = {System::kLeo, static_cast<std::uint16_t>(i)};
    state.time = test::kSkyEpoch;
    state.p_e << 7.4e6, 1e3 * i, 0.0;
    states.push_back(state);
  }
  return states;
}

}  // namespace

TEST_CASE("orbits of every satellite and an epoch at once keep no input waiting for the filter") {
  std::atomic<bool> holding{false}, released{false};
  Engine* held = nullptr;
  EngineHooks hooks;
  hooks.before_epoch = [&](std::uint64_t epoch) {
    if (epoch != 5) return;
    holding = true;
    // A full ring frees the stage, or this test could not end.
    while (!released && held->gnss_ring().waits == 0) test::wait_a_moment();
  };
  test::Collector outputs;
  Engine engine(test::drive_config(), &outputs, hooks);
  held = &engine;
  engine.start();
  Encoder encoder;
  int epochs = 0;
  std::uint64_t orbit_messages = 0;
  test::feed_messages(test::synthetic_drive(test::noisy_drive(8.0)), [&](Channel channel,
                                                                         ByteSpan bytes) {
    if (channel == Channel::kGnssEpoch && ++epochs == 6) {
      CHECK(holding.load());
      for (const int count : {100, 399}) {
        engine.receive(Channel::kOrbitClock, encoder.encode(states_of(count), ++orbit_messages), 1);
      }
    }
    engine.receive(channel, bytes, 1);
    while (!holding && !engine.idle()) test::wait_a_moment();
  });
  CHECK(orbit_messages == 2);
  CHECK(engine.gnss_ring().waits == 0);
  released = true;
  CHECK(engine.finish());
  for (const Gauge& rejected : engine.counters().rejected) CHECK(rejected.get() == 0);
  CHECK(outputs.groups[2].size() == 7);  // EPOCH
}
