// Where arcs end and where they must not: flags, gaps, half cycles, clock jumps.
#include "core/gnss/cycle_slips/carrier_arcs.h"

#include <cmath>
#include <limits>
#include <vector>

#include "support/catch.h"
#include "support/start_time.h"
#include "tools/common/allocations/allocation_counter.h"

namespace leonav {
namespace {

using test::kAnyTime;

constexpr double kClockJump_m = 299'792.458;

// Eight satellites on L1 and L2 whose ranges change by up to 700 m/s, without noise.
struct Receiver {
  double code_jump_m = 0.0, carrier_jump_m = 0.0;  // of all satellites
  double tag_s = 0.0;                              // of the time tag against the true time

  RawEpoch at(double t) const {
    RawEpoch raw;
    raw.time = kAnyTime.plus_seconds(t + tag_s);
    for (std::uint16_t n = 1; n <= 8; ++n) {
      const double rate = -700.0 + 175.0 * n;
      const double range = 2.2e7 + 1e5 * n + rate * t + 0.05 * t * t;
      for (const char band : {'1', '2'}) {
        SignalObservation o;
        o.satellite = {System::kGps, n};
        o.code = {band, band == '1' ? 'C' : 'W'};
        const double wavelength = wavelength_m(System::kGps, band);
        const double delay = (band == '1' ? 1.0 : 1.647) * (3.0 + 0.0002 * t);
        o.pseudorange_m = range + delay + code_jump_m;
        o.carrier_cycles = (range - delay + carrier_jump_m) / wavelength + 1000.0 * n;
        o.doppler_hz = -(rate + 0.1 * t) / wavelength;
        o.lock_time_s = 50.0 + t;
        raw.observations.push_back(o);
      }
    }
    return raw;
  }
};

std::vector<CarrierInput> inputs_of(const RawEpoch& raw, bool pairs = true) {
  std::vector<CarrierInput> inputs;
  for (std::size_t i = 0; i + 1 < raw.observations.size(); i += 2) {
    inputs.push_back({&raw.observations[i], pairs ? &raw.observations[i + 1] : nullptr, 0.8});
  }
  return inputs;
}

// Feeds epochs and settles them without a range change.
struct Run {
  CarrierArcs arcs{CycleSlipConfig{}};
  ArcEpoch epoch;

  const ArcEpoch& feed(const RawEpoch& raw, bool pairs = true) {
    arcs.process(raw.time, inputs_of(raw, pairs), &epoch);
    arcs.apply_range_change({}, &epoch);
    return epoch;
  }
  int started() const {
    int count = 0;
    for (const CarrierStatus& status : epoch.satellites) count += status.started;
    return count;
  }
};

Run settled_run(const Receiver& receiver, bool pairs = true) {
  Run run;
  for (int t = 0; t < 20; ++t) run.feed(receiver.at(t), pairs);
  REQUIRE(run.started() == 0);
  return run;
}

}  // namespace

TEST_CASE("Arcs are numbered from one and never twice", "[carrier_arcs]") {
  const Receiver receiver;
  Run run;
  run.feed(receiver.at(0));
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(run.epoch.satellites[i].arc == i + 1);
    CHECK(run.epoch.satellites[i].started);
    CHECK(!run.epoch.satellites[i].causes.any());
  }
  run.feed(receiver.at(1));
  CHECK(run.started() == 0);
  CHECK(run.epoch.satellites[3].arc == 4);
  const CarrierStatus ended = run.arcs.end_arc({System::kGps, 4}, SlipCause::kFilter);
  CHECK(ended.arc == 9);
  CHECK(ended.causes == SlipCauses(SlipCause::kFilter));
  run.feed(receiver.at(2));
  CHECK(run.started() == 0);
  CHECK(run.epoch.satellites[3].arc == 9);
  CHECK(run.arcs.end_arc({System::kGps, 30}, SlipCause::kFilter).arc == 0);
  CHECK(run.arcs.end_arc({System::kGps, 0}, SlipCause::kFilter).arc == 0);
}

TEST_CASE("Flags, lock times, gaps and other signals end an arc, each by its name",
          "[carrier_arcs]") {
  const Receiver receiver;
  struct Case {
    SlipCause cause;
    double t;
    void (*change)(RawEpoch*);
  };
  const Case cases[] = {
      {SlipCause::kLossOfLock, 20, [](RawEpoch* r) { r->observations[1].loss_of_lock = true; }},
      {SlipCause::kLockTime, 20, [](RawEpoch* r) { r->observations[0].lock_time_s = 0.5; }},
      {SlipCause::kGap, 31, [](RawEpoch*) {}},
      {SlipCause::kSignalChanged, 20,
       [](RawEpoch* r) {
         r->observations[1].code = {'2', 'X'};
       }},
      {SlipCause::kGeometryFree, 20, [](RawEpoch* r) { r->observations[0].carrier_cycles += 1; }},
      {SlipCause::kMelbourneWuebbena, 20,
       [](RawEpoch* r) {
         r->observations[0].carrier_cycles += 77;
         r->observations[1].carrier_cycles += 60;
       }},
  };
  for (const Case& c : cases) {
    CAPTURE(to_string(c.cause));
    Run run = settled_run(receiver);
    RawEpoch raw = receiver.at(c.t);
    c.change(&raw);
    run.feed(raw);
    CHECK(run.epoch.satellites[0].started);
    CHECK(run.epoch.satellites[0].causes.has(c.cause));
    CHECK(run.started() == (c.cause == SlipCause::kGap ? 8 : 1));
  }
  Run run = settled_run(receiver, false);
  RawEpoch raw = receiver.at(20);
  raw.observations[0].carrier_cycles += 4.0;
  run.feed(raw, false);
  CHECK(run.epoch.satellites[0].causes == SlipCauses(SlipCause::kDoppler));
  CHECK(run.started() == 1);
}

TEST_CASE("A short gap ends no arc, for LEO only a shorter one", "[carrier_arcs]") {
  const Receiver receiver;
  Run run = settled_run(receiver);
  run.feed(receiver.at(26));
  CHECK(run.started() == 0);
  // A receiver that measures every 30 s has no gap there, and may miss an epoch.
  Run slow;
  for (const double t : {0.0, 30.0, 60.0, 120.0}) {
    slow.feed(receiver.at(t));
    CHECK(slow.started() == (t == 0.0 ? 8 : 0));
  }
  slow.feed(receiver.at(210.0));
  CHECK(slow.started() == 8);
  Run leo;
  for (const double t : {0.0, 1.0, 2.0, 8.0}) {
    RawEpoch raw = receiver.at(t);
    for (SignalObservation& o : raw.observations) o.satellite.system = System::kLeo;
    leo.feed(raw);
  }
  CHECK(leo.started() == 8);
}

// A receiver's epoch out of turn says nothing of how far apart the others are.
TEST_CASE("A stray epoch a second after the last ends no arc", "[carrier_arcs]") {
  const Receiver receiver;
  for (const std::size_t satellites : {0, 2, 8}) {
    Run run;
    for (int k = 0; k < 6; ++k) run.feed(receiver.at(30.0 * k));
    RawEpoch stray = receiver.at(151.0);
    stray.observations.resize(2 * satellites);
    run.feed(stray);
    CAPTURE(satellites);
    CHECK(run.started() == 0);
    for (const double t : {180.0, 210.0, 240.0}) {
      run.feed(receiver.at(t));
      CHECK(run.started() == 0);
    }
  }
  // Nor does one without carriers come between two of one frequency.
  Run run;
  for (int k = 0; k < 6; ++k) run.feed(receiver.at(30.0 * k), false);
  RawEpoch empty = receiver.at(151.0);
  empty.observations.clear();
  run.feed(empty, false);
  run.feed(receiver.at(180.0), false);
  CHECK(run.started() == 0);
}

TEST_CASE("One frequency alone survives no epoch without its satellite", "[carrier_arcs]") {
  const Receiver receiver;
  for (const bool pairs : {true, false}) {
    Run run = settled_run(receiver, pairs);
    RawEpoch without = receiver.at(20);
    without.observations.erase(without.observations.begin(), without.observations.begin() + 2);
    run.feed(without, pairs);
    CHECK(run.started() == 0);
    run.feed(receiver.at(21), pairs);
    CHECK(run.started() == (pairs ? 0 : 1));
    CHECK((run.epoch.satellites[0].causes == SlipCauses(SlipCause::kGap)) == !pairs);
    // An epoch that all have missed is none: the geometry sees across it.
    run.feed(receiver.at(23), pairs);
    CHECK(run.started() == 0);
  }
}

TEST_CASE("A clock that jumps by milliseconds ends no arc, whatever the receiver's custom",
          "[carrier_arcs][clock_jump]") {
  for (const int milliseconds : {1, -1, 3}) {
    for (const bool pairs : {true, false}) {
      CAPTURE(milliseconds, pairs);
      const Receiver before;
      const double jump_m = milliseconds * kClockJump_m;
      // Codes jump; the epoch is sampled so much earlier.
      {
        Run run = settled_run(before, pairs);
        const double expected = run.epoch.satellites[2].first_m;
        Receiver after{jump_m, 0.0, milliseconds * 1e-3};
        run.feed(after.at(20.0 - milliseconds * 1e-3), pairs);
        CHECK(run.started() == 0);
        CHECK(run.epoch.clock_jump.code_ms == milliseconds);
        CHECK(run.epoch.clock_jump.carrier_ms == 0);
        // Carriers keep to the codes.
        CHECK(std::abs(run.epoch.satellites[2].first_m - expected - jump_m) < 2000.0);
        run.feed(after.at(21.0 - milliseconds * 1e-3), pairs);
        CHECK(run.started() == 0);
        CHECK(!run.epoch.clock_jump.any());  // reported once
      }
      // Both jump.
      {
        Run run = settled_run(before, pairs);
        Receiver after{jump_m, jump_m, milliseconds * 1e-3};
        run.feed(after.at(20.0 - milliseconds * 1e-3), pairs);
        CHECK(run.started() == 0);
        CHECK(run.epoch.clock_jump.code_ms == milliseconds);
        CHECK(run.epoch.clock_jump.carrier_ms == milliseconds);
      }
      // The tag alone.
      {
        Run run = settled_run(before, pairs);
        Receiver after{0.0, 0.0, milliseconds * 1e-3};
        run.feed(after.at(20.0), pairs);
        CHECK(run.started() == 0);
        CHECK(run.epoch.clock_jump.tag_ms == milliseconds);
      }
    }
  }
}

TEST_CASE("A slip at the epoch of a clock jump is that satellite's alone", "[carrier_arcs]") {
  Run run = settled_run(Receiver{});
  RawEpoch raw = Receiver{kClockJump_m, 0.0, 1e-3}.at(20.0 - 1e-3);
  raw.observations[4].carrier_cycles += 9.0;
  raw.observations[5].carrier_cycles += 7.0;
  run.feed(raw);
  CHECK(run.started() == 1);
  CHECK(run.epoch.satellites[2].started);
}

TEST_CASE("Codes that leave their carriers by no whole millisecond are one event",
          "[carrier_arcs][clock_jump]") {
  Run run = settled_run(Receiver{});
  run.feed(Receiver{70'000.0, 0.0, 0.0}.at(20.0));
  CHECK(run.epoch.clock_jump.unrepairable);
  CHECK(run.started() == 8);
  CHECK(run.epoch.satellites[0].causes == SlipCauses(SlipCause::kClockJump));
  run.feed(Receiver{70'000.0, 0.0, 0.0}.at(21.0));
  CHECK(run.started() == 0);
}

TEST_CASE("A half cycle that is resolved is repaired, another step is not", "[carrier_arcs]") {
  const Receiver receiver;
  for (const double step : {0.0, 0.5, -0.5, 0.25}) {
    CAPTURE(step);
    Run run;
    for (int t = 0; t < 20; ++t) {
      RawEpoch raw = receiver.at(t);
      raw.observations[0].half_cycle_ambiguous = true;
      run.feed(raw);
      CHECK(run.epoch.satellites[0].half_cycle_unresolved);
    }
    double last = run.epoch.satellites[0].first_m;
    RawEpoch raw = receiver.at(20);
    const double unstepped = raw.observations[0].carrier_cycles * wavelength_m(System::kGps, '1');
    raw.observations[0].carrier_cycles += step;
    run.feed(raw);
    CHECK(!run.epoch.satellites[0].half_cycle_unresolved);
    CHECK(run.epoch.satellites[0].started == (step == 0.25));
    CHECK(run.epoch.satellites[0].causes.has(SlipCause::kHalfCycle) == (step == 0.25));
    if (step != 0.25) CHECK(std::abs(run.epoch.satellites[0].first_m - unstepped) < 1e-6);
    CHECK(last != run.epoch.satellites[0].first_m);
    raw = receiver.at(21);
    raw.observations[0].carrier_cycles += step;
    run.feed(raw);
    CHECK(run.started() == 0);
  }
  Run run;
  for (int t = 0; t < 21; ++t) {
    RawEpoch raw = receiver.at(t);
    raw.observations[0].half_cycle_ambiguous = t < 20;
    run.feed(raw, false);
  }
  CHECK(run.epoch.satellites[0].causes.has(SlipCause::kHalfCycle));  // one frequency: cannot tell
}

TEST_CASE("A code gone astray is no slip, and a range change refutes what the codes suspect",
          "[carrier_arcs]") {
  Run run = settled_run(Receiver{});
  RawEpoch raw = Receiver{}.at(20);
  raw.observations[0].pseudorange_m += 30.0;  // one code
  run.feed(raw);
  CHECK(run.started() == 0);
  raw = Receiver{}.at(21);
  raw.observations[2].pseudorange_m += 20.0;  // both codes of a satellite
  raw.observations[3].pseudorange_m += 20.0;
  run.arcs.process(raw.time, inputs_of(raw), &run.epoch);
  CHECK(run.epoch.satellites[1].suspected.has(SlipCause::kMelbourneWuebbena));
  CHECK(!run.epoch.satellites[1].started);
  const std::vector<RangeChangeRowResult> results(8, {RangeChangeVerdict::kConsistent, 0.01});
  run.arcs.apply_range_change(results, &run.epoch);
  CHECK(run.started() == 0);
  // A deviation that the geometry-free combination rules out is not the carrier's.
  raw = Receiver{}.at(22);
  run.arcs.process(raw.time, inputs_of(raw), &run.epoch);
  std::vector<RangeChangeRowResult> clock(8, {RangeChangeVerdict::kConsistent, 0.0});
  clock[4] = {RangeChangeVerdict::kSlipped, 0.15};
  clock[5] = {RangeChangeVerdict::kSlipped, 0.9};
  run.arcs.apply_range_change(clock, &run.epoch);
  CHECK(run.started() == 1);
  CHECK(run.epoch.satellites[5].causes == SlipCauses(SlipCause::kRangeChange));
}

TEST_CASE("Where the geometry cannot tell, an arc of one frequency ends, that of a pair goes on",
          "[carrier_arcs]") {
  for (const bool pairs : {false, true}) {
    Run run = settled_run(Receiver{}, pairs);
    const RawEpoch raw = Receiver{}.at(20);  // with Dopplers, which see nothing below half a metre
    run.arcs.process(raw.time, inputs_of(raw, pairs), &run.epoch);
    std::vector<RangeChangeRowResult> results(8, {RangeChangeVerdict::kConsistent, 0.0, 0.01});
    results[0] = {RangeChangeVerdict::kUndecided, 0.0,
                  0.01};  // other slips would explain all as well
    results[1] = {RangeChangeVerdict::kUnclear, 0.08, 0.02};    // a cycle is 5.5 sigma further
    results[2] = {RangeChangeVerdict::kUnclear, -0.14, 0.035};  // and here 1.4 sigma
    run.arcs.apply_range_change(results, &run.epoch);
    CHECK(run.started() == (pairs ? 0 : 2));
    for (const std::size_t i : {0, 2}) {
      CHECK(run.epoch.satellites[i].causes ==
            (pairs ? SlipCauses() : SlipCauses(SlipCause::kRangeChange)));
    }
    // Ranges predicted for a clock that has jumped contradict the carriers, and nothing slipped.
    Receiver jumped;
    jumped.code_jump_m = kClockJump_m;
    const RawEpoch after = jumped.at(21);
    run.arcs.process(after.time, inputs_of(after, pairs), &run.epoch);
    REQUIRE(run.epoch.clock_jump.code_ms == 1);
    run.arcs.apply_range_change(
        std::vector<RangeChangeRowResult>(8, {RangeChangeVerdict::kUndecided, 0.0, 0.01}),
        &run.epoch);
    CHECK(run.started() == 0);
  }
}

TEST_CASE("Hostile input breaks nothing and allocates nothing", "[carrier_arcs]") {
  Run run = settled_run(Receiver{});
  RawEpoch raw = Receiver{}.at(20);
  raw.observations[0].carrier_cycles = std::numeric_limits<double>::infinity();
  raw.observations[2].pseudorange_m = std::numeric_limits<double>::quiet_NaN();
  raw.observations[4].doppler_hz = 1e300;
  raw.observations[6].lock_time_s = -1e300;
  raw.observations[8].satellite.number = 9999;
  raw.observations[10].code.band = 'x';
  std::vector<CarrierInput> inputs = inputs_of(raw);
  inputs.push_back({});
  inputs.push_back(inputs[7]);  // twice the same satellite
  inputs[7].elevation = std::numeric_limits<double>::quiet_NaN();
  start_counting_allocations();
  run.arcs.process(raw.time, inputs, &run.epoch);
  run.arcs.apply_range_change({}, &run.epoch);
  CHECK(stop_counting_allocations() == 0);
  REQUIRE(run.epoch.satellites.size() == 10);
  for (const std::size_t i : {0, 4, 5, 8, 9}) CHECK(run.epoch.satellites[i].arc == 0);
  CHECK(run.epoch.satellites[1].arc == 2);
  CHECK(run.epoch.satellites[7].arc == 8);
  CHECK(!run.epoch.satellites[7].started);
  // Time that stands or goes back starts over.
  run.feed(Receiver{}.at(20));
  CHECK(run.epoch.satellites[7].causes.has(SlipCause::kGap));
  run.feed(Receiver{}.at(3));
  CHECK(run.started() == 8);
  run.arcs.reset();
  run.feed(Receiver{}.at(4));
  CHECK(run.started() == 8);
  CHECK(!run.epoch.satellites[0].causes.any());
}

}  // namespace leonav
