// What the Sequencer takes of an IMU, and where it lays the samples.
#include "core/navigator/sequencer/sequencer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

TEST_CASE("bad IMU samples are rejected by reason and good ones after them count") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SequencerRig rig;
  rig.imu(0, 100);
  ImuSample bad = sample_until(at_ms(105));
  bad.delta_theta_b.y() = nan;
  rig.sequencer.on_imu(bad);
  CHECK(rig.rejected(InputFault::kNotFinite) == 1);
  bad = sample_until(at_ms(105));
  bad.delta_theta_b.x() = 40.0 * 0.005;
  rig.sequencer.on_imu(bad);
  bad = sample_until(at_ms(105));
  bad.delta_velocity_b.z() = -600.0 * 0.005;
  rig.sequencer.on_imu(bad);
  rig.sequencer.on_imu(sample_until(at_ms(105), 0));
  rig.sequencer.on_imu(sample_until(at_ms(105), -5));
  rig.sequencer.on_imu(sample_until(at_ms(105), 101 * kMs));
  rig.sequencer.on_imu(sample_until(GpsTime()));
  rig.sequencer.on_imu(
      sample_until(GpsTime::from_nanoseconds(std::numeric_limits<std::int64_t>::max())));
  CHECK(rig.rejected(InputFault::kOutOfRange) == 7);
  bad = sample_until(at_ms(105));
  bad.delta_theta_b.setZero();
  bad.delta_velocity_b.setZero();
  rig.sequencer.on_imu(bad);
  CHECK(rig.rejected(InputFault::kNotSane) == 1);
  rig.sequencer.on_imu(sample_until(at_ms(100)));
  CHECK(rig.rejected(InputFault::kDuplicate) == 1);
  rig.sequencer.on_imu(sample_until(at_ms(60)));
  CHECK(rig.rejected(InputFault::kTimeBackwards) == 1);
  rig.sequencer.on_imu(sample_until(at_ms(100'000)));
  CHECK(rig.rejected(InputFault::kTooFarAhead) == 1);
  CHECK(rig.stages.count(EventKind::kRejectedInput) == 12);
  CHECK(rig.stages.samples.size() == 20);

  rig.imu(100, 1100);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  CHECK(rig.sequencer.counters().imu_gaps == 0);
  REQUIRE(rig.stages.blocks.size() == 1);
  check_tiling(rig.stages);
}

TEST_CASE("stamps rounded to milliseconds leave no holes; increments stay") {
  SequencerRig rig;  // a 152 Hz stream whose stamps are whole milliseconds, 6 or 7 ms apart
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 1; i <= 600; ++i) {
    const auto ms = static_cast<std::int64_t>(std::lround(i * 1000.0 / 152.0));
    const ImuSample sample = sample_until(at_ms(ms), 6'578'947);
    sum += sample.delta_velocity_b;
    rig.sequencer.on_imu(sample);
  }
  CHECK(rig.sequencer.counters().imu == 600);
  CHECK(rig.sequencer.counters().imu_gaps == 0);
  check_tiling(rig.stages);
  Eigen::Vector3d passed = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : rig.stages.samples) passed += sample.delta_velocity_b;
  CHECK(passed == sum);
}

TEST_CASE("one wild stamp ahead costs its sample and nothing else") {
  for (const std::int64_t ahead_ms : {300, 500, 3000, 9000}) {
    CAPTURE(ahead_ms);
    SequencerRig rig;
    rig.imu(0, 1000);
    rig.sequencer.on_imu(sample_until(at_ms(1005 + ahead_ms)));
    rig.imu(1005, 2100);
    CHECK(rig.rejected(InputFault::kTooFarAhead) == 1);
    CHECK(rig.rejected(InputFault::kTimeBackwards) == 0);
    CHECK(rig.sequencer.counters().imu == 200 + 219);
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(2000)));
    CHECK(rig.sequencer.counters().late_epochs == 0);
    CHECK(rig.sequencer.counters().empty_epochs <= 1);
  }
}

TEST_CASE("a hole of three seconds is reported, left as a hole, and bridged by one epoch") {
  SequencerRig rig;
  rig.imu(0, 1100);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  rig.imu(4100, 6000);
  CHECK(rig.sequencer.counters().imu_gaps == 1);
  REQUIRE(rig.stages.count(EventKind::kImuGap) == 1);
  CHECK(std::find_if(rig.stages.events.begin(), rig.stages.events.end(), [](const Event& e) {
          return e.kind == EventKind::kImuGap;
        })->value == Approx(3.0));
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(6000)));
  REQUIRE(rig.stages.blocks.size() >= 3);
  CHECK(rig.stages.blocks[1].time == at_ms(4100));
  CHECK(rig.stages.blocks.back().time == at_ms(6000));
  CHECK(rig.stages.blocks.back().samples.back().time == at_ms(6000));
  CHECK(rig.stages.blocks.size() <= 4);
}

TEST_CASE("when the IMU stops, epochs go on without it and it may come back") {
  const NavigatorConfig config;
  SequencerRig rig(config);
  rig.imu(0, 1100);
  for (int k = 1; k <= 30; ++k) rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * k)));
  // Four waited for an IMU that might only be slow. At the fifth they were issued, and each later
  // one at once.
  CHECK(rig.stages.blocks.size() == 30);
  CHECK(rig.stages.blocks.back().samples.empty());
  REQUIRE(rig.stages.times_without_imu.size() == 25);
  CHECK(rig.stages.times_without_imu.front().time == at_ms(6000));
  CHECK(rig.stages.times_without_imu.back().time == at_ms(30'000));
  for (const EpochIssued& issued : rig.stages.issued) {
    const GpsTime expected = std::max(issued.time, at_ms(issued.index == 1 ? 1100 : 6000));
    CHECK(issued.deadline_ekf == expected.plus_seconds(config.realtime.deadline_ekf_s));
  }
  rig.imu(29'500, 31'000);
  CHECK(rig.stages.commands.empty());
  // It keeps time again.
  for (int k = 31; k <= 33; ++k) rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * k)));
  CHECK(rig.stages.blocks.size() == 31);
  CHECK(rig.stages.blocks.back().time == at_ms(31'000));
  CHECK_FALSE(rig.stages.blocks.back().samples.empty());
  CHECK(rig.stages.times_without_imu.size() == 25);
}

TEST_CASE("an IMU is silent after some epochs, however often these come") {
  const auto [interval_ms, expected] = GENERATE(
      table<int, int>({{50, 2050}, {100, 2100}, {1000, 4000}, {5000, 10'000}, {30'000, 30'000}}));
  CAPTURE(interval_ms);
  NavigatorConfig config;
  config.realtime.epoch_interval_s = 0.001 * interval_ms;
  SequencerRig rig(config);
  rig.imu(0, 1000);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  int ms = 1000 + interval_ms;
  for (const int first = ms; ms <= first + 4 * expected; ms += interval_ms) {
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(ms)));
    CHECK(rig.stages.times_without_imu.empty() == (ms - first < expected));
  }
  CHECK(rig.stages.blocks.back().time == at_ms(ms - interval_ms));  // none waits any more
  // An outage of GNSS as well, of any length, restarts nothing.
  for (int k = 0; k < 3; ++k)
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(ms + 600'000 + k * interval_ms)));
  CHECK(rig.stages.commands.empty());
  CHECK(rig.stages.blocks.back().time == at_ms(ms + 600'000 + 2 * interval_ms));
  for (std::size_t i = 1; i < rig.stages.issued.size(); ++i)
    CHECK(rig.stages.issued[i].deadline_ekf >= rig.stages.issued[i - 1].deadline_ekf);
}

TEST_CASE("the mounting turns IMU axes into the body frame") {
  NavigatorConfig config;
  config.vehicle.mounting_rpy = {0.0, 0.0, 1.5707963267948966};
  SequencerRig rig(config);
  rig.sequencer.on_imu(sample_until(at_ms(5)));
  const Eigen::Vector3d in = sample_until(at_ms(5)).delta_velocity_b;
  const Eigen::Vector3d out = rig.stages.samples.at(0).delta_velocity_b;
  CHECK((out - Eigen::Vector3d(-in.y(), in.x(), in.z())).norm() < 1e-15);
}

}  // namespace
}  // namespace leonav::test
