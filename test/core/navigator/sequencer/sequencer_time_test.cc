// What the Sequencer takes for an outage, a stray stamp, a clock that was set.
#include "core/navigator/sequencer/sequencer.h"

#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

// A SequencerRig that counts time in seconds.
struct SecondRig : SequencerRig {
  using SequencerRig::SequencerRig;

  void epochs(double from_s, double step_s, int count) {
    for (int k = 0; k < count; ++k) sequencer.on_raw_epoch(epoch_at(at_s(from_s + k * step_s)));
  }
  // IMU at 200 Hz over (from, to].
  void imu(double from_s, double to_s) {
    const auto count = static_cast<int>((to_s - from_s) * 200.0 + 0.5);
    for (int i = 1; i <= count; ++i) {
      ImuSample sample;
      sample.time = kStart.plus_seconds(from_s).plus_nanoseconds(i * 5'000'000LL);
      sample.interval_ns = 5'000'000;
      sample.delta_velocity_b.z() = -9.8 * 0.005;
      sequencer.on_imu(sample);
    }
  }
  // Both as a live system gets them, an epoch each second.
  void drive(double from_s, double to_s, double stamp_error_s = 0.0) {
    for (double t = from_s; t < to_s; t += 1.0) {
      imu(t, t + 1.0);
      sequencer.on_raw_epoch(epoch_at(at_s(t + 1.0 + stamp_error_s)));
    }
  }
  double last_s() const { return seconds_between(stages.blocks.back().time, kStart); }
};

NavigatorConfig gnss_only(double interval_s) {
  NavigatorConfig config;
  config.motion = MotionModel::kConstantVelocity;
  config.realtime.epoch_interval_s = interval_s;
  return config;
}

TEST_CASE("an interval other than configured costs no epoch") {
  for (const double configured_s : {0.1, 1.0, 30.0}) {
    for (const double interval_s : {0.1, 1.0, 30.0, 300.0}) {
      CAPTURE(configured_s, interval_s);
      SecondRig rig(gnss_only(configured_s));
      rig.epochs(0.0, interval_s, 100);
      // The newest may wait for the one after it.
      CHECK(rig.stages.blocks.size() >= 99);
      CHECK(rig.rejected() == 0);
      for (std::size_t k = 0; k < rig.stages.blocks.size(); ++k) {
        CHECK(rig.stages.blocks[k].time ==
              kStart.plus_seconds(static_cast<double>(k) * interval_s));
      }
    }
  }
  SecondRig station(gnss_only(30.0));
  station.epochs(0.0, 30.0, 721);
  CHECK(station.stages.blocks.size() == 721);
}

TEST_CASE("without an IMU an outage of any length costs no epoch and no restart") {
  SecondRig rig(gnss_only(1.0));
  rig.epochs(0.0, 1.0, 10);
  for (const double outage_end_s : {30.0, 700.0, 9'000.0, 700'000.0}) {
    const std::size_t before = rig.stages.blocks.size();
    rig.sequencer.on_raw_epoch(epoch_at(at_s(outage_end_s)));
    CHECK(rig.stages.blocks.size() == before);  // the next one will tell
    rig.epochs(outage_end_s + 1.0, 1.0, 9);
    REQUIRE(rig.stages.blocks.size() == before + 10);
    CHECK(rig.stages.blocks[before].time == kStart.plus_seconds(outage_end_s));
  }
  CHECK(rig.sequencer.counters().epochs == 50);
  CHECK(rig.rejected() == 0);
  CHECK(rig.stages.commands.empty());
}

TEST_CASE("without an IMU a stray stamp costs the epoch that has it and no other") {
  SecondRig rig(gnss_only(1.0));
  rig.epochs(0.0, 1.0, 10);
  rig.sequencer.on_raw_epoch(epoch_at(at_s(86'400.0)));
  rig.sequencer.on_raw_epoch(epoch_at(at_s(86'400.0)));  // twice
  rig.epochs(10.0, 1.0, 10);
  CHECK(rig.rejected(InputFault::kTooFarAhead) == 1);
  CHECK(rig.rejected(InputFault::kDuplicate) == 1);
  rig.sequencer.on_raw_epoch(epoch_at(at_s(-86'400.0)));
  rig.epochs(20.0, 1.0, 10);
  CHECK(rig.rejected(InputFault::kTimeBackwards) == 1);
  CHECK(rig.stages.blocks.size() == 30);
  CHECK(rig.last_s() == Approx(29.0));
  CHECK(rig.stages.commands.empty());
}

TEST_CASE("without an IMU a clock set back costs a short run, whatever the interval") {
  for (const double interval_s : {1.0, 30.0}) {
    CAPTURE(interval_s);
    SecondRig rig(gnss_only(1.0));
    rig.epochs(0.0, interval_s, 50);
    rig.epochs(-3'600.0, interval_s, 50);
    // And the one that was held, if any: nothing speaks for it.
    CHECK(rig.rejected() <= EpochStamps::kRunToRestart);
    CHECK(rig.stages.commands.size() == 1);
    CHECK(rig.last_s() > -3'600.0 + 47 * interval_s);
  }
}

TEST_CASE("without an IMU a clock set back by seconds costs five epochs, refused or late") {
  const double back_s = GENERATE(5.0, 9.0, 14.0, 60.0);
  CAPTURE(back_s);
  SecondRig rig(gnss_only(1.0));
  rig.epochs(0.0, 1.0, 50);
  rig.epochs(50.0 - back_s, 1.0, 10);
  CHECK(rig.rejected() + rig.sequencer.counters().late_epochs <= EpochStamps::kRunToRestart);
  CHECK(rig.last_s() == Approx(60.0 - back_s).margin(1.0));
}

TEST_CASE("stamps in UTC at first, leap seconds later: eighteen seconds either way") {
  for (const double error_s : {-18.0, 18.0}) {
    CAPTURE(error_s);
    SecondRig alone(gnss_only(1.0));
    alone.epochs(error_s, 1.0, 30);
    alone.epochs(30.0, 1.0, 60);
    CHECK(alone.last_s() == Approx(89.0));
    // Forward costs nothing; back, the clock has to be believed first.
    CHECK(alone.stages.blocks.size() >= 90 - EpochStamps::kRunToRestart);

    SecondRig with_imu{NavigatorConfig{}};
    with_imu.drive(0.0, 30.0);
    with_imu.drive(30.0, 60.0, error_s);  // the IMU keeps the time: refused, and counted
    CHECK(with_imu.rejected() == 30);
    with_imu.drive(60.0, 90.0);
    CHECK(with_imu.sequencer.counters().epochs == 60);
    CHECK(with_imu.stages.commands.empty());
    CHECK(with_imu.last_s() == Approx(90.0));
  }
}

TEST_CASE("power off for a minute: both streams are back after a tenth of a second") {
  SecondRig rig{NavigatorConfig{}};
  rig.drive(0.0, 10.0);
  rig.drive(70.0, 80.0);
  CHECK(rig.sequencer.counters().epochs == 20);
  CHECK(rig.rejected(InputFault::kTooFarAhead) == ImuIntake::kRunToRestart - 1);
  CHECK(rig.stages.commands.size() == 1);
  CHECK(rig.last_s() == Approx(80.0));

  SecondRig slow_imu{NavigatorConfig{}};  // comes up 20 s after GNSS
  slow_imu.drive(0.0, 10.0);
  slow_imu.epochs(70.0, 1.0, 20);
  slow_imu.drive(90.0, 100.0);
  CHECK(slow_imu.rejected() == EpochStamps::kRunWithImu - 1);
  CHECK(slow_imu.last_s() == Approx(100.0));
  CHECK(slow_imu.sequencer.counters().epochs == 40 - (EpochStamps::kRunWithImu - 1));
}

TEST_CASE("an IMU that starts late takes over the time GNSS has kept") {
  NavigatorConfig config;
  SecondRig rig(config);
  rig.epochs(0.0, 30.0, 10);  // 30 s where 1 s is expected: each waits for the next
  CHECK(rig.rejected() == 0);
  rig.imu(270.0, 270.1);  // the last one held belongs to this time
  CHECK(rig.sequencer.counters().epochs == 10);
  rig.drive(270.1, 280.1);
  CHECK(rig.sequencer.counters().epochs == 20);
  CHECK(rig.rejected() == 0);
}

TEST_CASE("epochs out of order take their place while the IMU has not passed them") {
  SecondRig rig{NavigatorConfig{}};
  rig.imu(0.0, 0.5);
  for (const double t : {2.0, 1.0, 3.0, 2.0}) rig.sequencer.on_raw_epoch(epoch_at(at_s(t)));
  CHECK(rig.rejected(InputFault::kDuplicate) == 1);
  rig.imu(0.5, 3.0);
  REQUIRE(rig.stages.blocks.size() == 3);
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    CHECK(rig.stages.blocks[i].time == kStart.plus_seconds(1.0 + k));
  }
}

}  // namespace
}  // namespace leonav::test
