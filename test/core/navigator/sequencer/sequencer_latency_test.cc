// Epochs that come late, again, or out of order.
#include "core/navigator/sequencer/sequencer.h"

#include <algorithm>
#include <utility>

#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

// Epochs as a receiver of this latency delivers them over a minute; those the
// stages saw.
std::size_t epochs_used(std::int64_t interval_ms, std::int64_t latency_ms, SequencerRig* rig) {
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

TEST_CASE(
    "a steady GNSS latency costs no epoch, one beyond the allowance the "
    "first ones") {
  struct Case {
    std::int64_t interval_ms, latency_ms;
    std::size_t lost;
  };
  // Until the first late epoch teaches the wait, those under way with it are
  // lost too.
  for (const Case& c : {Case{100, 60, 0}, Case{100, 150, 0}, Case{100, 300, 0}, Case{100, 900, 5},
                        Case{250, 200, 0}, Case{1000, 300, 0}, Case{1000, 520, 1},
                        Case{1000, 900, 1}, Case{30'000, 900, 0}}) {
    CAPTURE(c.interval_ms, c.latency_ms);
    NavigatorConfig config;
    config.realtime.epoch_interval_s = static_cast<double>(c.interval_ms) * 1e-3;
    SequencerRig rig(config);
    const auto sent = static_cast<std::size_t>(60'000 / c.interval_ms);
    const std::size_t used = epochs_used(c.interval_ms, c.latency_ms, &rig);
    CHECK(used + c.lost >= sent);
    CHECK(rig.sequencer.counters().late_epochs == sent - used);
    check_tiling(rig.stages);
  }
}

TEST_CASE("old epochs delivered again do not lengthen the wait") {
  SequencerRig rig;
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
  SequencerRig rig;
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

TEST_CASE("an IMU that comes late costs no epoch its samples, up to two seconds") {
  for (const auto& [interval_ms, latency_ms] :
       {std::pair(100, 600), {100, 1900}, {50, 1900}, {200, 1500}, {1000, 3500}}) {
    CAPTURE(interval_ms, latency_ms);
    NavigatorConfig config;
    config.realtime.epoch_interval_s = interval_ms * 1e-3;
    SequencerRig rig(config);
    for (int ms = 5; ms <= 30'000; ms += 5) {
      if (ms > latency_ms) rig.sequencer.on_imu(sample_until(at_ms(ms - latency_ms)));
      if (ms % interval_ms == 0) rig.sequencer.on_raw_epoch(epoch_at(at_ms(ms)));
    }
    const auto expected = static_cast<std::size_t>((30'000 - latency_ms) / interval_ms);
    REQUIRE(rig.stages.blocks.size() == expected);
    for (const auto& block : rig.stages.blocks) {
      CHECK_FALSE(block.empty);
      CHECK(block.samples.size() == static_cast<std::size_t>(interval_ms / 5));
    }
    CHECK(rig.sequencer.counters().epochs_without_imu == 0);
    check_tiling(rig.stages);
  }
}

TEST_CASE(
    "epochs whose IMU does not come are issued without it after two "
    "seconds, and told") {
  NavigatorConfig config;
  config.realtime.epoch_interval_s = 0.1;
  SequencerRig rig(config);
  rig.imu(0, 400);
  for (int ms = 1100; ms <= 20'000; ms += 100) rig.sequencer.on_raw_epoch(epoch_at(at_ms(ms)));
  CHECK(rig.stages.blocks.size() == 190);
  CHECK(rig.sequencer.counters().epochs_without_imu == 190);
  CHECK(rig.stages.times_without_imu.front().time == at_ms(1100 + 2100));
  CHECK(rig.stages.count(EventKind::kCapacity) == 16);  // then each 256th
  CHECK(rig.stages.blocks.back().samples.empty());
}

TEST_CASE("epochs at a high rate fill the table before the two seconds") {
  NavigatorConfig config;
  config.realtime.epoch_interval_s = 0.05;
  SequencerRig rig(config);
  rig.imu(0, 400);
  for (int ms = 1010; ms <= 3000; ms += 10) rig.sequencer.on_raw_epoch(epoch_at(at_ms(ms)));
  CHECK(rig.stages.blocks.size() == 200 - kMaxPendingEpochs);
  CHECK(rig.sequencer.counters().epochs_without_imu == 200 - kMaxPendingEpochs);
}

// A drive whose IMU samples, at 50 Hz, come late by `late_ms`, and its epochs by 100 ms; samples of
// times in (silent_from_s, silent_to_s] do not come. What the stages get of the last minute.
struct LateImuDrive {
  std::int64_t interval_ms, configured_ms, late_ms;
  double silent_from_s = 0.0, silent_to_s = 0.0;
  std::int64_t lost_epoch_s = -1;
  std::int64_t creep_ms_per_s = 0;  // after the first minute, up to late_ms; 0: late at once

  static constexpr std::int64_t kEnd_ms = 240'000, kJudged_ms = 180'000;
  std::size_t epochs = 0, whole = 0, alone = 0, restarts = 0;

  // Every epoch has reached the stages, but for the last ones, which may wait for their samples.
  bool are_issued() const {
    const auto sent = (kEnd_ms - kJudged_ms) / interval_ms, waiting = late_ms / interval_ms + 2;
    return static_cast<std::int64_t>(epochs) + waiting >= sent;
  }

  void run() {
    NavigatorConfig config;
    config.realtime.epoch_interval_s = static_cast<double>(configured_ms) * 1e-3;
    SequencerRig rig(config);
    std::int64_t next = interval_ms;
    std::int64_t sample = 20;
    for (std::int64_t ms = 20; ms <= kEnd_ms; ms += 20) {
      const std::int64_t crept_ms = creep_ms_per_s * std::max<std::int64_t>(ms - 60'000, 0) / 1000;
      const std::int64_t late_now_ms = creep_ms_per_s > 0 ? std::min(crept_ms, late_ms) : late_ms;
      for (; sample <= ms - late_now_ms; sample += 20) {
        const double s = static_cast<double>(sample) * 1e-3;
        if (s <= silent_from_s || s > silent_to_s)
          rig.sequencer.on_imu(sample_until(at_ms(sample), 20 * kMs));
      }
      for (; ms >= next + 100; next += interval_ms)
        if (next != 1000 * lost_epoch_s) rig.sequencer.on_raw_epoch(epoch_at(at_ms(next)));
    }
    restarts = rig.stages.commands.size();
    for (const auto& block : rig.stages.blocks) {
      if (block.empty || block.time <= at_ms(kJudged_ms)) continue;
      ++epochs;
      whole += !block.samples.empty() && block.samples.back().time == block.time ? 1 : 0;
    }
    for (const TimeWithoutImu& data : rig.stages.times_without_imu)
      alone += data.time > at_ms(kJudged_ms) ? 1 : 0;
  }
};

TEST_CASE(
    "however late the IMU is, either every epoch has its samples or GNSS alone answers each") {
  struct Rates {
    std::int64_t interval_ms, configured_ms;
  };
  for (const Rates& rates : {Rates{100, 100}, Rates{200, 200}, Rates{1000, 1000}, Rates{5000, 5000},
                             Rates{100, 1000}, Rates{1000, 5000}}) {
    for (std::int64_t late_ms = 0; late_ms <= 12'000; late_ms += 250) {
      for (const int silence_s : {0, 8, 60}) {
        LateImuDrive drive{rates.interval_ms, rates.configured_ms, late_ms, 60.0, 60.0 + silence_s};
        drive.run();
        CAPTURE(rates.interval_ms, rates.configured_ms, late_ms, silence_s, drive.epochs,
                drive.whole, drive.alone);
        CHECK(drive.are_issued());
        CHECK((drive.whole == drive.epochs || drive.alone >= drive.epochs));
        if (late_ms <= 9'000) CHECK(drive.restarts == 0);
      }
    }
  }
}

TEST_CASE("an IMU that becomes later and later is used, and then silent") {
  for (const std::int64_t interval_ms : {20, 40, 50, 100, 200, 1000, 5000}) {
    for (std::int64_t late_ms = 250; late_ms <= 9'000; late_ms += 250) {
      for (const std::int64_t creep_ms_per_s : {100, 1'000'000}) {
        LateImuDrive drive{interval_ms, std::max<std::int64_t>(interval_ms, 50), late_ms};
        drive.creep_ms_per_s = creep_ms_per_s;
        drive.run();
        CAPTURE(interval_ms, late_ms, creep_ms_per_s, drive.epochs, drive.whole, drive.alone);
        CHECK(drive.are_issued());
        CHECK((drive.whole == drive.epochs || drive.alone >= drive.epochs));
        CHECK(drive.restarts == 0);
      }
    }
  }
}

TEST_CASE("one wrong stamp ahead takes no right epoch from its IMU samples") {
  NavigatorConfig config;
  config.realtime.epoch_interval_s = 0.1;
  SequencerRig rig(config);
  // The IMU is 0.6 s late, so that six epochs wait.
  for (std::int64_t ms = 20; ms <= 20'000; ms += 20) {
    if (ms > 600) rig.sequencer.on_imu(sample_until(at_ms(ms - 600), 20 * kMs));
    if (ms % 100 == 0) rig.sequencer.on_raw_epoch(epoch_at(at_ms(ms)));
    if (ms == 10'000) rig.sequencer.on_raw_epoch(epoch_at(at_ms(ms + 5'000)));
  }
  CHECK(rig.sequencer.counters().epochs_without_imu == 0);
  CHECK(rig.stages.commands.empty());
}

TEST_CASE("an IMU too late to be used is silent again some epochs after one epoch is lost") {
  for (const std::int64_t late_ms : {4'600, 6'000, 8'000}) {
    LateImuDrive drive{1000, 1000, late_ms, 0.0, 0.0, 160};
    drive.run();
    CAPTURE(late_ms, drive.epochs, drive.whole, drive.alone);
    CHECK(drive.are_issued());
    CHECK(drive.alone >= drive.epochs);
    CHECK(drive.restarts == 0);
  }
}

}  // namespace
}  // namespace leonav::test
