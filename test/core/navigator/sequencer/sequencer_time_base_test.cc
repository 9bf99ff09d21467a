// A stray stamp against a clock that was set, with an IMU.
#include "core/navigator/sequencer/sequencer.h"

#include <algorithm>

#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

TEST_CASE("a stray stamp changes nothing; a clock that was set restarts everything") {
  SequencerRig rig;
  rig.imu(0, 2000);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(86'400'000)));
  CHECK(rig.rejected(InputFault::kTooFarAhead) == 1);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(2000)));
  CHECK(rig.stages.blocks.size() == 2);
  CHECK(rig.stages.commands.empty());

  for (const std::int64_t base : {86'400'000LL, -500'000LL}) {  // a day ahead, then back
    const std::size_t blocks = rig.stages.blocks.size(), restarts = rig.stages.commands.size();
    rig.imu(base, base + 1100);
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(base + 1000)));
    REQUIRE(rig.stages.commands.size() == restarts + 1);
    CHECK(rig.stages.commands.back().kind == CommandKind::kRestart);
    REQUIRE(rig.stages.blocks.size() == blocks + 1);
    CHECK(rig.stages.blocks.back().time == at_ms(base + 1000));
    // Of 200 samples all but the run it took.
    CHECK(rig.stages.blocks.back().samples.size() == 200 - (ImuIntake::kRunToRestart - 1));
  }
  CHECK(rig.rejected(InputFault::kTimeBackwards) == ImuIntake::kRunToRestart - 1);
}

TEST_CASE("a restart reaches both stages between the same two epochs, with its cause") {
  SequencerRig rig;
  rig.imu(0, 100);
  rig.sequencer.on_command({CommandKind::kRestart, 0.0, 0.0, ResetCause::kTimeBase});  // it lies
  rig.sequencer.on_command({CommandKind::kSetHeading, 1.0, 0.1});
  rig.imu(86'400'000, 86'400'200);
  REQUIRE(rig.stages.commands.size() == 3);
  CHECK(rig.stages.commands[0].cause == ResetCause::kCommand);
  CHECK(rig.stages.commands[2].cause == ResetCause::kTimeBase);
  CHECK(rig.stages.restarts_at_command == std::vector<std::size_t>{1, 1, 2});
  REQUIRE(rig.stages.restarts.size() == 2);
  CHECK(rig.stages.restarts[0].cause == ResetCause::kCommand);
  CHECK(rig.stages.restarts[1].cause == ResetCause::kTimeBase);

  NavigatorConfig config;
  config.motion = MotionModel::kConstantVelocity;  // nobody answers there
  SequencerRig without_imu(config);
  without_imu.sequencer.on_command({CommandKind::kRestart, 0.0, 0.0});
  CHECK(without_imu.stages.commands.size() == 1);
  CHECK(without_imu.stages.restarts.empty());
}

// Findings of the Sequencer.
std::size_t findings(const SequencerRig& rig) {
  return static_cast<std::size_t>(std::count_if(
      rig.stages.events.begin(), rig.stages.events.end(),
      [](const Event& event) { return event.kind == EventKind::kConventionSuspect; }));
}

TEST_CASE("in a new time the stamps of IMU and GNSS are compared anew") {
  SequencerRig rig;
  constexpr std::int64_t kOffset = 3'600'000, kDay = 86'400'000;
  const auto drive = [&](std::int64_t from_s, std::int64_t to_s) {
    for (std::int64_t s = from_s; s < to_s; ++s) {
      rig.imu(1000 * s + kOffset, 1000 * (s + 1) + kOffset);
      rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * (s + 1))));
    }
  };
  drive(0, 20);
  REQUIRE(findings(rig) == 1);
  // Both clocks step by a day, and are as far apart as before. No single epoch proves it.
  drive(kDay / 1000, kDay / 1000 + 8);
  REQUIRE(rig.stages.commands.size() == 1);
  CHECK(findings(rig) == 1);
  drive(kDay / 1000 + 8, kDay / 1000 + 20);
  CHECK(findings(rig) == 2);
}

TEST_CASE("samples that were refused in the old time do not convict an IMU in the new one") {
  SequencerRig rig;
  const auto too_fast = [&](std::int64_t from_ms, int count) {
    for (int k = 1; k <= count; ++k) {
      ImuSample sample = sample_until(at_ms(from_ms + 5 * k));
      sample.delta_theta_b = Eigen::Vector3d(1.0, 0.0, 0.0);  // 200 rad/s
      rig.sequencer.on_imu(sample);
    }
  };
  rig.imu(0, 1000);
  too_fast(1000, 99);
  rig.imu(86'400'000, 86'400'150);
  REQUIRE(rig.stages.commands.size() == 1);
  too_fast(86'400'150, 60);
  CHECK(rig.rejected(InputFault::kOutOfRange) == 159);
  CHECK(findings(rig) == 0);
  too_fast(86'400'450, 60);
  CHECK(findings(rig) == 1);
}

TEST_CASE("GNSS alone cannot change the time the IMU keeps") {
  SequencerRig rig;
  for (int k = 0; k < 20; ++k) {
    rig.imu(1000 * k, 1000 * (k + 1));
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * k + 3'600'000)));
  }
  CHECK(rig.rejected(InputFault::kTooFarAhead) == 20);
  CHECK(rig.stages.commands.empty());
}

}  // namespace
}  // namespace leonav::test
