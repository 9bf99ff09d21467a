// A run with an odometer: the threads, the journal and the replay give the same bits.
#include <cmath>
#include <thread>

#include "daemon/engine/engine.h"
#include "engine_runs.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;

NavigatorConfig car(Estimator estimator, bool odometer) {
  NavigatorConfig config = test::drive_config().navigator;
  config.estimator = estimator;
  config.realtime.deadline_smoother_s = 0.5;
  MotionConstraintConfig& motion = config.vehicle.motion.constraints;
  motion.non_holonomic = motion.zero_velocity = true;
  motion.odometer = odometer;
  config.ekf.vehicle = {2, {0.03, 0.03, 0.03}, {3e-5, 3e-5, 2e-5}};
  return config;
}

// A minute's drive; ten increments a second, 1 % too long.
std::vector<test::Input> messages() {
  std::vector<test::Input> list;
  Encoder encoder;
  const test::SyntheticPath path(test::noisy_drive(60.0));
  std::uint64_t samples = 0, increments = 0;
  test::feed_messages(test::synthetic_drive(test::noisy_drive(60.0)), [&](Channel channel,
                                                                          ByteSpan bytes) {
    list.push_back({channel, test::Bytes(bytes.begin(), bytes.end())});
    if (channel != Channel::kImu || ++samples % 20 != 0) return;
    const double end_s = static_cast<double>(samples) / 200.0;
    const double way_m = 0.101 * path.state(end_s - 0.05).v_e.norm();
    const ByteSpan odometer = encoder.encode(
        OdometerIncrement{test::kSkyEpoch.plus_seconds(end_s), 100'000'000, way_m}, ++increments);
    list.push_back({Channel::kOdometer, test::Bytes(odometer.begin(), odometer.end())});
  });
  return list;
}

}  // namespace

TEST_CASE("a run with an odometer replays from its journal bit for bit") {
  const Estimator estimator = GENERATE(Estimator::kEkf, Estimator::kSmoother);
  const std::vector<test::Input> list = messages();
  const test::TemporaryFile place("unused", "");
  DaemonConfig config = test::drive_config();
  config.navigator = car(estimator, true);
  config.journal.path = place.beside("run.journal");
  test::Collector live;
  Engine engine(config, &live);
  engine.start();
  for (const test::Input& input : list) {
    engine.receive(input.channel, input.bytes, 1);
    while (!engine.idle()) test::wait_a_moment();
  }
  REQUIRE(engine.finish());
  CHECK(engine.counters().accepted_odometer.get() == 600);
  CHECK(engine.counters().odometer_age_ms.get() == 0);
  for (const Gauge& rejected : engine.counters().rejected) CHECK(rejected.get() == 0);

  const auto journaled = test::read_journal_inputs(config.journal.path);
  REQUIRE(journaled.size() == list.size());
  REQUIRE(test::missed_epochs(live).empty());
  check_same(live, test::run_navigator(config.navigator, journaled, {}));
  const auto without = test::run_navigator(car(estimator, false), journaled, {});
  CHECK(without.groups[0] != live.groups[0]);  // it did count
}
