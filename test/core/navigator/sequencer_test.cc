#include "core/navigator/sequencer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "recording_stages.h"
#include "support/catch.h"

namespace leonav::test {
namespace {

const GpsTime kStart = GpsTime::from_week_and_tow(2200, 100'000.0);
constexpr std::int64_t kMs = 1'000'000;

GpsTime at_ms(std::int64_t ms) { return kStart.plus_nanoseconds(ms * kMs); }

ImuSample sample_until(GpsTime time, std::int64_t interval_ns = 5 * kMs) {
  ImuSample sample;
  sample.time = time;
  sample.interval_ns = interval_ns;
  const double dt = sample.interval_s();
  sample.delta_theta_b << 0.1 * dt, -0.2 * dt, 0.3 * dt;
  sample.delta_velocity_b << 0.5 * dt, 0.1 * dt, -9.8 * dt;
  return sample;
}

RawEpoch epoch_at(GpsTime time) {
  RawEpoch raw;
  raw.time = time;
  SignalObservation observation;
  observation.satellite = {System::kGps, 5};
  observation.code = {'1', 'C'};
  observation.pseudorange_m = 2.2e7;
  raw.observations.push_back(observation);
  return raw;
}

struct Rig {
  NavigatorConfig config;
  RecordingStages stages;
  Sequencer sequencer;
  explicit Rig(const NavigatorConfig& c = {}) : config(c), sequencer(c, &stages) {}
  // IMU at 200 Hz over (from, to] milliseconds.
  void imu(std::int64_t from_ms, std::int64_t to_ms) {
    for (std::int64_t ms = from_ms + 5; ms <= to_ms; ms += 5) {
      sequencer.on_imu(sample_until(at_ms(ms)));
    }
  }
  std::uint64_t rejected(InputFault fault) const {
    return sequencer.counters().rejected[static_cast<std::size_t>(fault)];
  }
};

// Blocks must tile the IMU stream: contiguous, cut exactly at the epochs, nothing lost.
void check_tiling(const RecordingStages& stages) {
  GpsTime end = stages.samples.front().start();
  Eigen::Vector3d theta = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
  for (const auto& block : stages.blocks) {
    for (const ImuSample& sample : block.samples) {
      REQUIRE(sample.start() == end);
      REQUIRE(sample.interval_ns > 0);
      end = sample.time;
      theta += sample.delta_theta_b;
      velocity += sample.delta_velocity_b;
    }
    REQUIRE(end == block.time);
  }
  Eigen::Vector3d theta_in = Eigen::Vector3d::Zero(), velocity_in = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : stages.samples) {
    if (sample.start() >= end) break;
    const double share =
        sample.time <= end ? 1.0 : seconds_between(end, sample.start()) / sample.interval_s();
    theta_in += share * sample.delta_theta_b;
    velocity_in += share * sample.delta_velocity_b;
  }
  CHECK((theta - theta_in).norm() < 1e-12 * (1.0 + theta_in.norm()));
  CHECK((velocity - velocity_in).norm() < 1e-12 * (1.0 + velocity_in.norm()));
}

TEST_CASE("blocks are cut exactly at the epochs, whatever phase and latency the epochs have") {
  std::mt19937 generator(7);
  for (int round = 0; round < 50; ++round) {
    Rig rig;
    std::uniform_int_distribution<std::int64_t> phase(1, 999'999'999), latency(-40, 400);
    const std::int64_t phase_ns = phase(generator);
    std::vector<std::pair<GpsTime, RawEpoch>> arrivals;
    for (int k = 0; k < 10; ++k) {
      const GpsTime t = kStart.plus_nanoseconds(phase_ns + k * 1'000 * kMs);
      arrivals.emplace_back(t.plus_nanoseconds(latency(generator) * kMs), epoch_at(t));
    }
    std::size_t next = 0;
    for (std::int64_t ms = 5; ms <= 9'450 + phase_ns / kMs; ms += 5) {
      for (; next < arrivals.size() && arrivals[next].first <= at_ms(ms); ++next) {
        rig.sequencer.on_raw_epoch(arrivals[next].second);
      }
      rig.sequencer.on_imu(sample_until(at_ms(ms)));
    }
    REQUIRE(rig.stages.blocks.size() == 10);
    for (std::size_t k = 0; k < 10; ++k) {
      CHECK(rig.stages.blocks[k].time == arrivals[k].second.time);
      CHECK(rig.stages.blocks[k].index == k + 1);
      CHECK(rig.stages.issued[k].time == arrivals[k].second.time);
      CHECK_FALSE(rig.stages.blocks[k].empty);
    }
    CHECK(rig.stages.opened.size() == 10);
    check_tiling(rig.stages);
  }
}

TEST_CASE("an epoch's work does not depend on how late it arrives; its deadline does") {
  const auto run = [](std::int64_t latency_ms) {
    Rig rig;
    rig.imu(0, 1000 + latency_ms);
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000).plus_nanoseconds(123'456)));
    rig.imu(1000 + latency_ms, 2000);
    return rig.stages;
  };
  const RecordingStages early = run(0), late = run(300);
  REQUIRE(early.blocks.size() == 1);
  REQUIRE(late.blocks.size() == 1);
  REQUIRE(early.blocks[0].samples.size() == late.blocks[0].samples.size());
  for (std::size_t i = 0; i < early.blocks[0].samples.size(); ++i) {
    const ImuSample &a = early.blocks[0].samples[i], &b = late.blocks[0].samples[i];
    CHECK(a.time == b.time);
    CHECK(a.delta_theta_b == b.delta_theta_b);
    CHECK(a.delta_velocity_b == b.delta_velocity_b);
  }
  // tau is the IMU's time when the epoch was issued: 1.005 s, not 1.000123456; D is 0.2 s.
  CHECK(early.issued[0].deadline_ekf == at_ms(1205));
  CHECK(late.issued[0].deadline_ekf == at_ms(1500));
}

TEST_CASE("without GNSS empty epochs keep the blocks bounded, one interval apart") {
  Rig rig;
  rig.imu(0, 1100);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  rig.imu(1100, 2495);
  CHECK(rig.stages.blocks.size() == 1);  // not yet 1.5 intervals
  rig.imu(2495, 2500);
  REQUIRE(rig.stages.blocks.size() == 2);
  CHECK(rig.stages.blocks[1].empty);
  CHECK(rig.stages.blocks[1].time == at_ms(2000));
  rig.imu(2500, 60'000);
  CHECK(rig.stages.blocks.size() == 59);
  CHECK(rig.sequencer.counters().empty_epochs == 58);
  check_tiling(rig.stages);

  rig.sequencer.on_raw_epoch(epoch_at(at_ms(60'000)));  // GNSS is back
  CHECK(rig.stages.blocks.size() == 60);
  CHECK_FALSE(rig.stages.blocks.back().empty);
  check_tiling(rig.stages);
}

TEST_CASE("a block that would overflow is closed early") {
  NavigatorConfig config;
  config.realtime.epoch_interval_s = 60.0;
  Rig rig(config);
  rig.imu(0, 30'000);
  // 7.68 s fill a block; what is half of the long interval old at most stays for an epoch under
  // way.
  for (const auto& block : rig.stages.blocks) {
    CHECK(block.samples.size() >= kMaxImuBlock / 4);
    CHECK(block.samples.size() <= kMaxImuBlock);
  }
  check_tiling(rig.stages);
}

// Epochs as a receiver of this latency delivers them over a minute; those the stages saw.
std::size_t epochs_used(std::int64_t interval_ms, std::int64_t latency_ms, Rig* rig) {
  std::int64_t next = interval_ms;
  for (std::int64_t ms = 5; ms <= 60'000 + latency_ms; ms += 5) {
    rig->sequencer.on_imu(sample_until(at_ms(ms)));
    if (next <= 60'000 && ms >= next + latency_ms) {
      rig->sequencer.on_raw_epoch(epoch_at(at_ms(next)));
      next += interval_ms;
    }
  }
  const auto& blocks = rig->stages.blocks;
  return static_cast<std::size_t>(
      std::count_if(blocks.begin(), blocks.end(), [](const auto& b) { return !b.empty; }));
}

TEST_CASE("a steady GNSS latency costs no epoch, one beyond the allowance the first ones") {
  struct Case {
    std::int64_t interval_ms, latency_ms;
    std::size_t lost;
  };
  // Until the first late epoch teaches the wait, those under way with it are lost too.
  for (const Case& c : {Case{100, 60, 0}, Case{100, 150, 0}, Case{100, 300, 0}, Case{100, 900, 5},
                        Case{250, 200, 0}, Case{1000, 300, 0}, Case{1000, 520, 1},
                        Case{1000, 900, 1}, Case{30'000, 900, 0}}) {
    CAPTURE(c.interval_ms, c.latency_ms);
    NavigatorConfig config;
    config.realtime.epoch_interval_s = static_cast<double>(c.interval_ms) * 1e-3;
    Rig rig(config);
    const auto sent = static_cast<std::size_t>(60'000 / c.interval_ms);
    const std::size_t used = epochs_used(c.interval_ms, c.latency_ms, &rig);
    CHECK(used + c.lost >= sent);
    CHECK(rig.sequencer.counters().late_epochs == sent - used);
    check_tiling(rig.stages);
  }
}

TEST_CASE("old epochs delivered again do not lengthen the wait") {
  Rig rig;
  for (int k = 1; k <= 3; ++k) {
    rig.imu(1000 * (k - 1), 1000 * k);
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * k)));
  }
  rig.imu(3000, 4500);
  CHECK(rig.stages.blocks.back().time == at_ms(4000));
  for (int i = 0; i < 20; ++i) rig.sequencer.on_raw_epoch(epoch_at(at_ms(2000)));
  rig.imu(4500, 5500);
  CHECK(rig.stages.blocks.back().time == at_ms(5000));
}

TEST_CASE("late and repeated epochs are counted and dropped, and cost nothing else") {
  Rig rig;
  rig.imu(0, 1010);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  CHECK(rig.rejected(InputFault::kDuplicate) == 1);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(400)));
  CHECK(rig.sequencer.counters().late_epochs == 1);
  REQUIRE(rig.stages.count(EventKind::kLateEpoch) == 1);
  CHECK(rig.stages.events.back().value == Approx(0.6));
  rig.imu(1010, 2600);  // the empty epoch for 2000 is out
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(2000)));
  CHECK(rig.sequencer.counters().late_epochs == 2);
  rig.imu(2600, 3000);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(3000)));
  CHECK(rig.stages.blocks.back().time == at_ms(3000));
  CHECK_FALSE(rig.stages.blocks.back().empty);
  check_tiling(rig.stages);
}

TEST_CASE("bad IMU samples are rejected by reason and good ones after them count") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Rig rig;
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
  rig.sequencer.on_imu(sample_until(at_ms(100)));
  CHECK(rig.rejected(InputFault::kDuplicate) == 1);
  rig.sequencer.on_imu(sample_until(at_ms(60)));
  CHECK(rig.rejected(InputFault::kTimeBackwards) == 1);
  rig.sequencer.on_imu(sample_until(at_ms(100'000)));
  CHECK(rig.rejected(InputFault::kTooFarAhead) == 1);
  CHECK(rig.stages.count(EventKind::kRejectedInput) == 11);
  CHECK(rig.stages.samples.size() == 20);

  rig.imu(100, 1100);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  CHECK(rig.sequencer.counters().imu_gaps == 0);
  REQUIRE(rig.stages.blocks.size() == 1);
  check_tiling(rig.stages);
}

TEST_CASE("stamps rounded to milliseconds leave no holes; increments stay") {
  Rig rig;  // a 152 Hz stream whose stamps are whole milliseconds, 6 or 7 ms apart
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

TEST_CASE("a hole of three seconds is reported, left as a hole, and bridged by one epoch") {
  Rig rig;
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
  Rig rig;
  rig.imu(0, 1100);
  for (int k = 1; k <= 30; ++k) rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * k)));
  // Four always wait for an IMU that may only be slow.
  CHECK(rig.stages.blocks.size() == 26);
  CHECK(rig.stages.blocks.back().samples.empty());
  rig.imu(29'500, 31'000);
  CHECK(rig.stages.blocks.size() == 30);
  CHECK(rig.stages.blocks.back().time == at_ms(30'000));
  CHECK(rig.stages.commands.empty());
}

TEST_CASE("a stray stamp changes nothing; a clock that was set restarts everything") {
  Rig rig;
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
    CHECK(rig.stages.blocks.back().samples.size() == 200 - (Sequencer::kImuRunToRestart - 1));
  }
  CHECK(rig.rejected(InputFault::kTimeBackwards) == Sequencer::kImuRunToRestart - 1);
}

TEST_CASE("GNSS alone cannot change the time the IMU keeps") {
  Rig rig;
  for (int k = 0; k < 20; ++k) {
    rig.imu(1000 * k, 1000 * (k + 1));
    rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * k + 3'600'000)));
  }
  CHECK(rig.rejected(InputFault::kTooFarAhead) == 20);
  CHECK(rig.stages.commands.empty());
}

TEST_CASE("without an IMU epochs are issued at once, nothing goes to the inertial stage") {
  NavigatorConfig config;
  config.motion = MotionModel::kConstantVelocity;
  Rig rig(config);
  rig.imu(0, 50);
  for (int k = 1; k <= 5; ++k) rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * k)));
  CHECK(rig.stages.blocks.size() == 5);
  CHECK(rig.stages.samples.empty());
  CHECK(rig.stages.issued.empty());
  CHECK(rig.stages.opened.empty());
}

TEST_CASE("observations that no receiver can have made are left out, the rest is sorted") {
  Rig rig;
  rig.imu(0, 1000);
  RawEpoch raw = epoch_at(at_ms(1000));
  SignalObservation o = raw.observations[0];
  o.satellite = {System::kGps, 3};
  raw.observations.push_back(o);
  raw.observations.push_back(o);  // again
  o.satellite = {System::kGps, 999};
  raw.observations.push_back(o);
  rig.sequencer.on_raw_epoch(raw);
  REQUIRE(rig.stages.blocks.size() == 1);
  CHECK(rig.stages.blocks[0].observations == 2);
  CHECK(rig.rejected(InputFault::kNotSane) == 1);
}

TEST_CASE("the mounting turns IMU axes into the body frame") {
  NavigatorConfig config;
  config.vehicle.mounting_rpy = {0.0, 0.0, 1.5707963267948966};
  Rig rig(config);
  rig.sequencer.on_imu(sample_until(at_ms(5)));
  const Eigen::Vector3d in = sample_until(at_ms(5)).delta_velocity_b;
  const Eigen::Vector3d out = rig.stages.samples.at(0).delta_velocity_b;
  CHECK((out - Eigen::Vector3d(-in.y(), in.x(), in.z())).norm() < 1e-15);
}

TEST_CASE("hostile commands, ephemerides and precise states are counted and dropped") {
  Rig rig;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  rig.sequencer.on_command({CommandKind::kSetHeading, nan, 0.1});
  rig.sequencer.on_command({CommandKind::kSetHeading, 1.0, -0.1});
  rig.sequencer.on_command({static_cast<CommandKind>(77), 1.0, 0.1});
  rig.sequencer.on_ephemeris(Ephemeris());
  PreciseState state;
  state.satellite = {System::kGps, 4};
  state.time = kStart;
  state.p_e << nan, 0, 0;
  rig.sequencer.on_precise_state(state);
  state.p_e.setZero();
  rig.sequencer.on_precise_state(state);
  rig.sequencer.on_rejected(InputFault::kUndecodable);
  CHECK(rig.rejected(InputFault::kNotFinite) == 2);
  CHECK(rig.rejected(InputFault::kOutOfRange) == 3);
  CHECK(rig.rejected(InputFault::kNotSane) == 1);
  CHECK(rig.rejected(InputFault::kUndecodable) == 1);
  CHECK(rig.stages.commands.empty());
}

}  // namespace
}  // namespace leonav::test
