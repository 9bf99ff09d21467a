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
  constexpr std::int64_t kOffset = -8'000, kDay = 86'400'000;
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

TEST_CASE("GNSS alone cannot change the time that IMU and GNSS keep together") {
  SequencerRig rig;
  rig.imu(0, 1000);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  for (int k = 1; k < 21; ++k) {
    rig.imu(1000 * k, 1000 * (k + 1));
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * k + 3'600'000)));
  }
  CHECK(rig.rejected(InputFault::kTooFarAhead) == 20);
  CHECK(rig.stages.commands.empty());
}

TEST_CASE("messages that are repeated or swapped delay no new time") {
  const std::int64_t leap_ms = GENERATE(-3'600'000, -12'000, 6'000, 12'000, 3'600'000);
  const bool swapped = GENERATE(false, true);
  CAPTURE(leap_ms, swapped);
  SequencerRig rig;
  const std::int64_t base = 7'200'000;
  for (int s = 0; s < 60; ++s) {
    rig.imu(base + leap_ms + 1000 * s, base + leap_ms + 1000 * (s + 1));
    const std::int64_t ms = base + 1000 * (s + 1);
    if (swapped && s % 2 != 0) continue;  // came before the one before
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(swapped ? ms + 1000 : ms)));
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(ms)));
  }
  CHECK(rig.stages.commands.size() == 1);
  CHECK(rig.stages.times_without_imu.size() > (swapped ? 20 : 40));
}

TEST_CASE("a second receiver an hour off changes nothing, however long") {
  SequencerRig rig;
  const std::int64_t base = 7'200'000;
  for (int s = 0; s < 700; ++s) {
    const std::int64_t ms = base + 1000 * s;
    rig.imu(ms, ms + 500);
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(ms + 500 + 3'600'000)));
    rig.imu(ms + 500, ms + 1000);
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(ms + 1000)));
  }
  CHECK(rig.stages.commands.empty());
  CHECK(rig.rejected() == 700);
}

TEST_CASE("GNSS that contradicts IMU and past for more than five minutes is followed") {
  for (const std::int64_t leap_ms : {-3'600'000LL, -12'000LL, 12'000LL, 3'600'000LL}) {
    CAPTURE(leap_ms);
    SequencerRig rig;
    const std::int64_t base = 7'200'000;
    const auto drive = [&](int from_s, int to_s, std::int64_t gnss_off_ms) {
      for (int s = from_s; s < to_s; ++s) {
        rig.imu(base + 1000 * s, base + 1000 * (s + 1));
        rig.sequencer.on_raw_epoch(epoch_at(at_ms(base + 1000 * (s + 1) + gnss_off_ms)));
      }
    };
    drive(0, 10, 0);
    drive(10, 311, leap_ms);
    CHECK(rig.stages.commands.empty());
    drive(311, 312, leap_ms);
    REQUIRE(rig.stages.commands.size() == 1);
    const std::size_t before = rig.stages.times_without_imu.size();
    drive(312, 332, leap_ms);
    CHECK(rig.stages.times_without_imu.size() >= before + 14);
    CHECK(rig.stages.commands.size() == 1);
    drive(332, 352, 0);  // right again: IMU and GNSS fit
    CHECK(rig.stages.blocks.back().samples.size() >= 199);
  }
}

TEST_CASE("an IMU whose clock leaps away is left, and followed again once it is right or alone") {
  constexpr std::int64_t kHour = 3'600'000;
  // At the start, or after IMU and GNSS have kept time together; ahead or behind.
  const int alone_s = GENERATE(0, 3, 20), together_s = GENERATE(0, 10);
  const std::int64_t leap_ms =
      GENERATE(-3'600'000, -8'000, -6'000, -4'500, 6'000, 12'000, 3'600'000);
  CAPTURE(alone_s, together_s, leap_ms);
  SequencerRig rig;
  const auto base = 2 * kHour;  // milliseconds
  int s = 0;
  const auto drive = [&](int seconds, std::int64_t imu_off_ms, bool gnss) {
    for (const int end = s + seconds; s < end; ++s) {
      rig.imu(base + imu_off_ms + 1000 * s, base + imu_off_ms + 1000 * (s + 1));
      if (gnss) rig.sequencer.on_raw_epoch(epoch_at(at_ms(base + 1000 * (s + 1))));
    }
  };
  const auto issued_since = [&](std::size_t before, bool with_samples) {
    std::size_t count = 0;
    for (std::size_t i = before; i < rig.stages.blocks.size(); ++i)
      count += rig.stages.blocks[i].observations > 0 &&
                       rig.stages.blocks[i].samples.empty() != with_samples
                   ? 1
                   : 0;
    return count;
  };
  for (const int end = s + alone_s; s < end; ++s)
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(base + 1000 * (s + 1))));
  drive(together_s, 0, true);
  drive(30, leap_ms, true);
  // Five epochs contradict the IMU, and five more show that nothing comes from it.
  std::size_t before = rig.stages.blocks.size();
  drive(20, leap_ms, true);
  CHECK(issued_since(before, false) == 20);
  CHECK(rig.stages.times_without_imu.size() >= 20);
  const std::size_t restarts = rig.stages.commands.size();
  // One to the IMU's time, where that is too far from a time kept before, and one back. Samples
  // that are some seconds behind are as late ones.
  const bool is_late = leap_ms < 0 && leap_ms >= -8'000;
  const bool is_led_away = together_s > 0 ? std::abs(leap_ms) > 10'000 : alone_s > 0 && leap_ms < 0;
  const std::size_t of_late = together_s > 0 ? 1 : 0;
  CHECK(restarts == (is_late ? of_late : is_led_away ? 2 : 1));
  SECTION("right again") {
    before = rig.stages.blocks.size();
    drive(10, 0, true);
    CHECK(issued_since(before, true) >= 9);
    CHECK(rig.stages.commands.size() == restarts);
  }
  SECTION("alone") {
    drive(8, leap_ms, false);
    CHECK(rig.stages.commands.size() == restarts);
    drive(4, leap_ms, false);
    // Late ones pass the last epoch.
    REQUIRE(rig.stages.commands.size() == restarts + (is_late ? 0 : 1));
    CHECK(rig.sequencer.imu_time() == at_ms(base + leap_ms + 1000 * s));
  }
}

}  // namespace
}  // namespace leonav::test
