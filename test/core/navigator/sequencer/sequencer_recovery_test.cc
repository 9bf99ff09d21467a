// Whatever stamps came before, good inputs are used again within seconds.
#include <algorithm>
#include <random>

#include "core/navigator/sequencer/sequencer.h"
#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

// Inputs with wrong stamps in between those of a drive with IMU and GNSS, in milliseconds.
struct MillisecondRig : SequencerRig {
  using SequencerRig::SequencerRig;

  std::int64_t now_ms = 0;

  void epoch(std::int64_t ms) { sequencer.on_raw_epoch(epoch_at(at_ms(ms))); }
  void sample(std::int64_t ms) { sequencer.on_imu(sample_until(at_ms(ms))); }
  void odometer(std::int64_t ms) { sequencer.on_odometer({at_ms(ms), 20 * kMs, 0.1}); }
  void drive(std::int64_t seconds) {
    for (std::int64_t k = 0; k < seconds; ++k, now_ms += 1000) {
      for (std::int64_t ms = 5; ms <= 1000; ms += 5) {
        sample(now_ms + ms);
        if (ms % 20 == 0) odometer(now_ms + ms);
      }
      epoch(now_ms + 1000);
    }
  }
  // Returns how many epochs of the last seconds were issued with their observations and IMU.
  std::int64_t good_epochs(std::int64_t seconds) const {
    std::int64_t count = 0;
    for (std::int64_t k = 0; k < seconds; ++k) {
      const GpsTime time = at_ms(now_ms - 1000 * k);
      count += std::any_of(stages.blocks.begin(), stages.blocks.end(), [&](const auto& block) {
        return !block.empty && block.time == time && block.samples.size() >= 199;
      });
    }
    return count;
  }
};

TEST_CASE("a burst of epochs of another time between two IMU samples costs nothing") {
  for (const std::int64_t ahead_ms :
       {-86'400'000LL, -60'000LL, 12'000LL, 60'000LL, 3'600'000LL, 86'400'000LL}) {
    for (const double interval_s : {0.1, 1.0}) {
      CAPTURE(ahead_ms, interval_s);
      NavigatorConfig config;
      config.realtime.epoch_interval_s = interval_s;
      const int burst = interval_s < 1.0 ? 100 : EpochStamps::kRunWithImu - 1;
      MillisecondRig rig(config);
      rig.drive(5);
      for (int k = 0; k < burst; ++k)
        rig.epoch(rig.now_ms + ahead_ms + static_cast<std::int64_t>(1000 * interval_s) * k);
      rig.drive(5);
      if (interval_s == 1.0) CHECK(rig.good_epochs(10) == 10);
      CHECK(rig.stages.commands.empty());
      CHECK(rig.rejected() == static_cast<std::uint64_t>(burst));
    }
  }
}

TEST_CASE("GNSS that goes on in another time while the IMU stays silent is followed") {
  for (const std::int64_t ahead_ms : {-3'600'000LL, 60'000LL, 3'600'000LL}) {
    CAPTURE(ahead_ms);
    MillisecondRig rig;
    rig.drive(5);
    // Those behind might be what a stalled link had held back.
    const int rejected = ahead_ms < 0 ? 61 : EpochStamps::kRunWithImu - 1;
    for (int k = 0; k < rejected + 20; ++k) rig.epoch(rig.now_ms + ahead_ms + 1000 * k);
    REQUIRE(rig.stages.commands.size() == 1);
    CHECK(rig.stages.commands[0].cause == ResetCause::kTimeBase);
    CHECK(rig.rejected() == static_cast<std::uint64_t>(rejected));
  }
}

TEST_CASE("epochs that a link held back while it stalled, or sends again, cost nothing") {
  const bool sent_again = GENERATE(false, true);
  for (const int held_s : {4, 9, 15, 25, 60}) {
    CAPTURE(held_s, sent_again);
    MillisecondRig rig;
    rig.drive(30);
    const std::int64_t stall_ms = rig.now_ms;
    if (!sent_again) {
      rig.imu(rig.now_ms, rig.now_ms + 1000 * held_s);
      rig.now_ms += 1000 * held_s;
    }
    for (int k = 1; k <= held_s; ++k)
      rig.epoch((sent_again ? stall_ms - 1000 * held_s : stall_ms) + 1000 * k);
    rig.drive(5);
    CHECK(rig.good_epochs(5) == 5);
    CHECK(rig.stages.commands.empty());
  }
}

TEST_CASE("right epochs wait for their IMU samples, although wrong ones wait far ahead of them") {
  MillisecondRig rig;
  rig.drive(5);
  for (int k = 6; k < 10; ++k) rig.epoch(rig.now_ms + 1000 * k);
  for (int k = 0; k < 5; ++k, rig.now_ms += 1000) {
    rig.imu(rig.now_ms, rig.now_ms + 980);
    rig.epoch(rig.now_ms + 1000);
    rig.imu(rig.now_ms + 980, rig.now_ms + 1000);
  }
  CHECK(rig.good_epochs(5) == 5);
  CHECK(rig.sequencer.counters().epochs_without_imu == 0);
}

TEST_CASE("epochs stamped in the future while no IMU sample comes do not end navigation") {
  for (const std::int64_t ahead_ms : {11'000LL, 60'000LL, 3'600'000LL, 86'400'000LL}) {
    CAPTURE(ahead_ms);
    MillisecondRig rig;
    rig.drive(5);
    for (int k = 0; k < 30; ++k) rig.epoch(rig.now_ms + ahead_ms + 1000 * k);
    rig.drive(5);
    CHECK(rig.good_epochs(3) == 3);
  }
}

TEST_CASE("an IMU that is silent while GNSS is an hour ahead is followed when it comes back") {
  MillisecondRig rig;
  rig.drive(5);
  for (int k = 0; k < 10; ++k) rig.epoch(rig.now_ms + 3'600'000 + 1000 * k);
  rig.now_ms += 10'000;
  rig.drive(5);
  CHECK(rig.good_epochs(3) == 3);
}

TEST_CASE("an IMU that begins after wrong epochs is followed") {
  MillisecondRig rig;
  for (int k = 0; k < 3; ++k) rig.epoch(3'600'000 + 1000 * k);
  rig.drive(5);
  CHECK(rig.good_epochs(3) == 3);
}

TEST_CASE("epochs that lead ahead step by step do not make the right ones late") {
  MillisecondRig rig;
  rig.drive(3);
  for (int k = 1; k <= 200; ++k) {
    rig.epoch(rig.now_ms + 8000 * k);
    if (k % 20 == 0) rig.sample(rig.now_ms += 5);
  }
  rig.drive(4);
  CHECK(rig.good_epochs(2) == 2);
}

// Adds one of twelve sorts of input, most of them wrong.
void disturb(std::mt19937_64* dice, MillisecondRig* rig) {
  const auto draw = [&](std::int64_t from, std::int64_t to) {
    return std::uniform_int_distribution<std::int64_t>(from, to)(*dice);
  };
  constexpr std::int64_t kOffsets[] = {5'000,     9'900,      12'000,      100'000,
                                       3'600'000, 86'400'000, 604'800'000, 10'000'000'000};
  const std::int64_t offset = kOffsets[draw(0, 7)] * (draw(0, 1) == 0 ? 1 : -1);
  const std::int64_t count = draw(1, 30), step = draw(1, 9'900);
  const std::int64_t base = rig->now_ms + offset;
  switch (draw(0, 11)) {
    case 0:
      return rig->drive(draw(1, 3));
    case 1:  // wrong epochs
      for (std::int64_t k = 0; k < count; ++k) rig->epoch(base + 1000 * k);
      return;
    case 2:  // epochs that lead away
      for (std::int64_t k = 0; k < count; ++k) rig->epoch(rig->now_ms + step * k);
      return;
    case 3:  // wrong samples
      for (std::int64_t k = 0; k < 10 * count; ++k) rig->sample(base + 5 * k);
      return;
    case 4:  // samples that lead away
      for (std::int64_t k = 0; k < count; ++k) rig->sample(rig->now_ms + step * k);
      return;
    case 5:  // a clock that runs backwards
      for (std::int64_t k = 0; k < 20 * count; ++k) rig->sample(rig->now_ms - draw(1, 60) * k);
      return;
    case 6:  // two streams of samples at once
      for (std::int64_t k = 1; k <= 10 * count; ++k) {
        rig->sample(rig->now_ms + 5 * k);
        rig->sample(base + 5 * k);
      }
      rig->now_ms += 50 * count;
      return;
    case 7:  // everything in another time
      rig->now_ms += offset;
      rig->drive(draw(1, 3));
      rig->now_ms -= offset;
      return;
    case 8:  // a wrong odometer
      for (std::int64_t k = 0; k < 10 * count; ++k) rig->odometer(base + 20 * k);
      return;
    case 9:  // nothing for a while
      rig->now_ms += draw(1, 100'000);
      return;
    case 10:  // epochs without an order
      for (std::int64_t k = 0; k < count; ++k) rig->epoch(rig->now_ms + draw(-20'000, 20'000));
      return;
    default:
      return rig->sequencer.on_command({CommandKind::kRestart, 0.0, 0.0});
  }
}

TEST_CASE("after any sequence of wrong stamps thirteen seconds of good inputs bring good epochs") {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 dice(seed);
    MillisecondRig rig;
    for (int k = 0; k < 12; ++k) disturb(&dice, &rig);
    rig.now_ms += 1000 - rig.now_ms % 1000;
    rig.drive(13);  // a stamp ten seconds ahead is waited for
    rig.sample(rig.now_ms + 5);
    CHECK(rig.good_epochs(2) == 2);
    CHECK(rig.sequencer.odometer_time() == at_ms(rig.now_ms));
  }
}

}  // namespace
}  // namespace leonav::test
