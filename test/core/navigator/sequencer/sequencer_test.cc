#include "core/navigator/sequencer/sequencer.h"

#include <random>
#include <utility>
#include <vector>

#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

TEST_CASE("blocks are cut exactly at the epochs, whatever phase and latency the epochs have") {
  std::mt19937 generator(7);
  for (int round = 0; round < 50; ++round) {
    SequencerRig rig;
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
    SequencerRig rig;
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
  SequencerRig rig;
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
  SequencerRig rig(config);
  rig.imu(0, 30'000);
  // 7.68 s fill a block; what is half of the long interval old at most stays for an epoch under
  // way.
  for (const auto& block : rig.stages.blocks) {
    CHECK(block.samples.size() >= kMaxImuBlock / 4);
    CHECK(block.samples.size() <= kMaxImuBlock);
  }
  check_tiling(rig.stages);
}

TEST_CASE("without an IMU epochs are issued at once, nothing goes to the inertial stage") {
  NavigatorConfig config;
  config.motion = MotionModel::kConstantVelocity;
  SequencerRig rig(config);
  rig.imu(0, 50);
  for (int k = 1; k <= 5; ++k) rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * k)));
  CHECK(rig.stages.blocks.size() == 5);
  CHECK(rig.stages.samples.empty());
  CHECK(rig.stages.issued.empty());
  CHECK(rig.stages.opened.empty());
}

}  // namespace
}  // namespace leonav::test
