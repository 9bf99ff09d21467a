// A stray stamp against a clock that was set, with an IMU.
#include "core/navigator/sequencer.h"

#include "sequencer_rig.h"
#include "support/catch.h"

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
    CHECK(rig.stages.blocks.back().samples.size() == 200 - (Sequencer::kImuRunToRestart - 1));
  }
  CHECK(rig.rejected(InputFault::kTimeBackwards) == Sequencer::kImuRunToRestart - 1);
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
