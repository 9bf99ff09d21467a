// An odometer's increments in the total order: with which epoch they go, what is late, what is
// refused.
#include <limits>

#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

NavigatorConfig with_odometer() {
  NavigatorConfig config;
  config.vehicle.motion.constraints.odometer = true;
  return config;
}

OdometerIncrement increment(std::int64_t end_ms) { return {at_ms(end_ms), 100 * kMs, 1.0, true}; }

std::vector<std::int64_t> ends_ms(const std::vector<OdometerIncrement>& increments) {
  std::vector<std::int64_t> ends;
  for (const OdometerIncrement& one : increments)
    ends.push_back((one.time.nanoseconds() - kStart.nanoseconds()) / kMs);
  return ends;
}

using Ends = std::vector<std::int64_t>;

TEST_CASE("increments go with the first epoch that they end by and are in time for") {
  SequencerRig rig(with_odometer());
  rig.imu(0, 1100);
  rig.sequencer.on_odometer(increment(900));
  rig.sequencer.on_odometer(increment(1000));
  rig.sequencer.on_odometer(increment(1100));
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  rig.imu(1100, 3000);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(2000)));
  rig.sequencer.on_odometer(increment(1550));  // too late
  rig.sequencer.on_odometer(increment(1650));  // after its epoch, with the next
  rig.sequencer.on_odometer(increment(3000));
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(3000)));
  REQUIRE(rig.stages.blocks.size() == 3);
  CHECK(ends_ms(rig.stages.blocks[0].odometer) == Ends{900, 1000});
  CHECK(ends_ms(rig.stages.blocks[1].odometer) == Ends{1100});
  CHECK(ends_ms(rig.stages.blocks[2].odometer) == Ends{1650, 3000});
  CHECK(rig.sequencer.counters().odometer == 6);
  CHECK(rig.sequencer.counters().late_odometer == 1);
  CHECK(rig.rejected() == 0);
  CHECK(rig.sequencer.odometer_time() == at_ms(3000));
}

TEST_CASE("hostile increments are counted by their reason and dropped") {
  SequencerRig rig(with_odometer());
  rig.imu(0, 500);
  rig.sequencer.on_odometer(increment(400));
  const auto send = [&](auto change) {
    OdometerIncrement bad = increment(500);
    change(&bad);
    rig.sequencer.on_odometer(bad);
  };
  send([](OdometerIncrement* o) { o->distance_m = std::numeric_limits<double>::quiet_NaN(); });
  send([](OdometerIncrement* o) { o->distance_m = -std::numeric_limits<double>::infinity(); });
  CHECK(rig.rejected(InputFault::kNotFinite) == 2);
  send([](OdometerIncrement* o) { o->distance_m = 15.1; });  // 151 m/s
  send([](OdometerIncrement* o) { o->interval_ns = 0; });
  send([](OdometerIncrement* o) { o->interval_ns = 1'000'000'001; });
  send([](OdometerIncrement* o) { o->time = GpsTime::from_nanoseconds(-5); });
  send([](OdometerIncrement* o) { *o = {at_ms(500), 100 * kMs, -1.0, false}; });
  CHECK(rig.rejected(InputFault::kOutOfRange) == 5);
  send([](OdometerIncrement* o) { o->time = at_ms(400); });
  CHECK(rig.rejected(InputFault::kDuplicate) == 1);
  send([](OdometerIncrement* o) { o->time = at_ms(300); });
  CHECK(rig.rejected(InputFault::kTimeBackwards) == 1);
  send([](OdometerIncrement* o) { o->time = at_ms(2501); });
  CHECK(rig.rejected(InputFault::kTooFarAhead) == 1);
  CHECK(rig.sequencer.counters().odometer == 1);
  rig.sequencer.on_odometer(increment(500));
  CHECK(rig.sequencer.counters().odometer == 2);
}

TEST_CASE("a way that is told twice is refused: sums over a sliding interval") {
  SequencerRig rig(with_odometer());
  rig.imu(0, 1000);
  rig.sequencer.on_odometer(increment(300));
  rig.sequencer.on_odometer(increment(380));  // stamps that jitter
  rig.sequencer.on_odometer(increment(430));
  CHECK(rig.rejected(InputFault::kOverlap) == 1);
  rig.sequencer.on_odometer(increment(480));
  CHECK(rig.sequencer.counters().odometer == 3);
}

TEST_CASE("more increments than have a place are refused, and the next epoch makes room") {
  SequencerRig rig(with_odometer());
  rig.imu(0, 1000);
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(kMaxOdometerBlock) + 7; ++i) {
    OdometerIncrement one = increment(100);
    one.time = one.time.plus_nanoseconds(i * kMs);
    one.interval_ns = kMs;
    one.distance_m = 0.01;
    rig.sequencer.on_odometer(one);
  }
  CHECK(rig.rejected(InputFault::kTooMany) == 7);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  CHECK(rig.stages.blocks.at(0).odometer.size() == kMaxOdometerBlock);
  rig.sequencer.on_odometer(increment(990));
  CHECK(rig.rejected(InputFault::kTooMany) == 7);
}

TEST_CASE("a wild stamp ahead blocks nothing for longer than a run of consistent ones") {
  SequencerRig rig(with_odometer());
  rig.imu(0, 1100);
  rig.sequencer.on_odometer(increment(3000));
  for (std::int64_t ms = 100; ms <= 1000; ms += 100) rig.sequencer.on_odometer(increment(ms));
  CHECK(rig.rejected(InputFault::kTimeBackwards) == 4);
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  REQUIRE_FALSE(rig.stages.blocks.empty());
  CHECK(ends_ms(rig.stages.blocks[0].odometer) == Ends{500, 600, 700, 800, 900, 1000});
}

TEST_CASE("a new time forgets the odometer of the old one") {
  SequencerRig rig(with_odometer());
  rig.imu(0, 900);
  rig.sequencer.on_odometer(increment(800));
  rig.imu(7'200'000, 7'201'100);
  rig.sequencer.on_odometer(increment(7'200'900));
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(7'201'000)));
  REQUIRE_FALSE(rig.stages.blocks.empty());
  CHECK(ends_ms(rig.stages.blocks.back().odometer) == Ends{7'200'900});
}

TEST_CASE("where no odometer is wanted, increments are judged and go nowhere") {
  SequencerRig rig;
  rig.imu(0, 1100);
  rig.sequencer.on_odometer(increment(900));
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  CHECK(rig.sequencer.counters().odometer == 1);
  CHECK(rig.stages.blocks.at(0).odometer.empty());
}

}  // namespace
}  // namespace leonav::test
