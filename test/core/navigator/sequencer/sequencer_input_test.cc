// Inputs that are refused by themselves, wherever they stand in time.
#include "core/navigator/sequencer/sequencer.h"

#include <limits>

#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

TEST_CASE("observations that no receiver can have made are left out, the rest is sorted") {
  SequencerRig rig;
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

TEST_CASE("an IMU sample with an impossible stamp is refused whatever the time offset") {
  for (const double offset_s : {-1.0, 0.0, 1.0}) {
    NavigatorConfig config;
    config.imu_time_offset_s = offset_s;
    SequencerRig rig(config);
    for (const std::int64_t stamp_ns : {std::int64_t{0}, std::int64_t{-1}, INT64_MIN, INT64_MAX}) {
      rig.sequencer.on_imu(sample_until(GpsTime::from_nanoseconds(stamp_ns)));
    }
    CHECK(rig.rejected(InputFault::kOutOfRange) == 4);
    CHECK(rig.stages.samples.empty());
  }
}

TEST_CASE("hostile commands, ephemerides, antennas and precise states are counted and dropped") {
  SequencerRig rig;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  rig.sequencer.on_command({CommandKind::kSetHeading, nan, 0.1});
  rig.sequencer.on_command({CommandKind::kSetHeading, 1.0, -0.1});
  rig.sequencer.on_command({static_cast<CommandKind>(77), 1.0, 0.1});
  rig.sequencer.on_ephemeris(Ephemeris());
  rig.sequencer.on_antenna(AntennaPattern());
  PreciseState state;
  state.satellite = {System::kGps, 4};
  state.time = kStart;
  state.p_e << nan, 0, 0;
  rig.sequencer.on_precise_states({state});
  state.p_e.setZero();
  rig.sequencer.on_precise_states({state});
  rig.sequencer.on_rejected(InputFault::kUndecodable);
  CHECK(rig.rejected(InputFault::kNotFinite) == 2);
  CHECK(rig.rejected(InputFault::kOutOfRange) == 3);
  CHECK(rig.rejected(InputFault::kNotSane) == 2);
  CHECK(rig.rejected(InputFault::kUndecodable) == 1);
  CHECK(rig.stages.commands.empty());
  CHECK(rig.stages.precise.empty());
}

TEST_CASE("of many commands at once five are taken, and five more ten seconds later") {
  SequencerRig rig;
  const auto command = [&] { rig.sequencer.on_command({CommandKind::kRestart, 0.0, 0.0}); };
  rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000)));
  for (int i = 0; i < 50; ++i) command();
  CHECK(rig.stages.commands.size() == 5);
  CHECK(rig.rejected(InputFault::kTooOften) == 45);
  for (int s = 2; s <= 12; ++s) rig.sequencer.on_raw_epoch(epoch_at(at_ms(1000 * s)));
  command();
  CHECK(rig.stages.commands.size() == 6);
}

TEST_CASE("coefficients of the ionosphere that no message can carry are dropped") {
  SequencerRig rig;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  KlobucharModel good = {.alpha = {-0x1p-23, 127 * 0x1p-27, 0.0, -0x1p-17},
                         .beta = {127 * 0x1p11, -0x1p21, 0x1p23, 0.0},
                         .valid = true};
  rig.sequencer.on_klobuchar(good);
  CHECK(rig.rejected(InputFault::kOutOfRange) == 0);
  for (std::size_t i = 0; i < 4; ++i) {
    KlobucharModel bad = good;
    bad.alpha[i] = 1e-4;
    rig.sequencer.on_klobuchar(bad);
    bad = good;
    bad.beta[i] = -1e8;
    rig.sequencer.on_klobuchar(bad);
    bad.beta[i] = nan;
    rig.sequencer.on_klobuchar(bad);
  }
  CHECK(rig.rejected(InputFault::kOutOfRange) == 8);
  CHECK(rig.rejected(InputFault::kNotFinite) == 4);
}

TEST_CASE("the good states of a message are one piece of work, each bad one is counted") {
  SequencerRig rig;
  PreciseStates states;
  for (std::uint16_t number = 1; number <= 30; ++number) {
    PreciseState state;
    state.satellite = {System::kGps, number};
    state.time = kStart;
    state.p_e << 2.6e7, 0.0, 0.0;
    if (number % 10 == 0) state.p_e.x() = 1.0;
    states.push_back(state);
  }
  rig.sequencer.on_precise_states(states);
  rig.sequencer.on_precise_states({});
  REQUIRE(rig.stages.precise.size() == 1);
  CHECK(rig.rejected(InputFault::kOutOfRange) == 3);
  REQUIRE(rig.stages.precise[0].size() == 27);
  CHECK(rig.stages.precise[0][9].satellite.number == 11);  // in their order, without the tenth
}

}  // namespace
}  // namespace leonav::test
