// What a stage's epochs leave for HEALTH.
#include "daemon/engine/internal/stage_sink.h"

#include <memory>

#include "support/catch.h"

using namespace leonav;

TEST_CASE("satellites that lose their precise orbits and get them back are counted") {
  Wakeup wakeup;
  EngineCounters counters;
  StageSink sink(1 << 20, &wakeup, &counters);
  const auto epoch = [&](OrbitSource gps, OrbitSource leo) {
    const auto report = std::make_unique<EpochReport>();
    report->satellites.resize(2);
    report->satellites[0].satellite = {System::kGps, 7};
    report->satellites[0].source = gps;
    report->satellites[1].satellite = {System::kLeo, 399};
    report->satellites[1].source = leo;
    sink.on_epoch(*report);
  };
  using enum OrbitSource;
  epoch(kBroadcast, kPrecise);
  CHECK(counters.orbit_fallbacks.get() == 0);
  CHECK(counters.orbit_returns.get() == 0);
  epoch(kPrecise, kNone);
  epoch(kPrecise, kPrecise);
  CHECK(counters.orbit_fallbacks.get() == 0);
  CHECK(counters.orbit_returns.get() == 1);
  epoch(kBroadcast, kBroadcast);
  epoch(kPrecise, kBroadcast);
  CHECK(counters.orbit_fallbacks.get() == 2);
  CHECK(counters.orbit_returns.get() == 2);
}

TEST_CASE("what became of checkpoints is counted, and each epoch's goes to who keeps it") {
  Wakeup wakeup;
  EngineCounters counters;
  LatestValue<Checkpoint> checkpoints;
  StageSink sink(1 << 20, &wakeup, &counters, &checkpoints);
  Event event;
  event.kind = EventKind::kCheckpoint;
  event.code = static_cast<std::uint8_t>(CheckpointUse::kElsewhere);
  event.value = 100.25;
  sink.on_event(event);
  CHECK(counters.checkpoints_ignored.get() == 1);
  CHECK(counters.checkpoint_use.get() == 1 + event.code);
  CHECK(counters.checkpoint_milli.get() == 100'250);
  event.code = static_cast<std::uint8_t>(CheckpointUse::kUsed);
  sink.on_event(event);
  CHECK(counters.checkpoints_used.get() == 1);
  // What is said about the calibration does not hide it.
  event.code = static_cast<std::uint8_t>(CheckpointUse::kCalibrationUsed);
  event.value = 7.5;
  sink.on_event(event);
  CHECK(counters.calibration_use.get() == 1 + event.code);
  CHECK(counters.calibration_milli.get() == 7'500);
  CHECK(counters.checkpoint_use.get() == 1 + static_cast<int>(CheckpointUse::kUsed));
  CHECK(counters.checkpoints_used.get() == 1);
  CHECK(counters.checkpoints_ignored.get() == 1);

  const auto report = std::make_unique<EpochReport>();
  Checkpoint taken;
  sink.on_epoch(*report);
  CHECK_FALSE(checkpoints.take(&taken));
  report->checkpoint = Checkpoint();
  report->checkpoint->heading = 1.5;
  sink.on_epoch(*report);
  REQUIRE(checkpoints.take(&taken));
  CHECK(taken.heading == 1.5);
}

TEST_CASE("the counters know of steps that were shortened and of solves left to the chain") {
  Wakeup wakeup;
  EngineCounters counters;
  StageSink sink(1 << 20, &wakeup, &counters);
  SmootherReport report;
  report.shortened = 2;
  sink.on_smoother(report);
  report.left_to_chain = true;
  sink.on_smoother(report);
  CHECK(counters.smoother_shortened.get() == 4);
  CHECK(counters.smoother_left_to_chain.get() == 1);
}

TEST_CASE("the cause of a start stays when the filter takes over the smoother's window after it") {
  Wakeup wakeup;
  EngineCounters counters;
  StageSink sink(1 << 20, &wakeup, &counters);
  Event event;
  event.stage = Stage::kGnss;
  event.kind = EventKind::kFilterReset;
  for (const ResetCause cause : {ResetCause::kHeading, ResetCause::kWindow}) {
    event.code = static_cast<std::uint8_t>(cause);
    sink.on_event(event);
    CHECK(counters.reset_cause.get() == static_cast<int>(ResetCause::kHeading));
    CHECK(counters.filter_starts.get() == 1);
  }
  CHECK(counters.events[static_cast<std::size_t>(EventKind::kFilterReset)].get() == 2);
}

TEST_CASE("a time step voids what its stage has found about stamps, and nothing else") {
  Wakeup wakeup;
  EngineCounters counters;
  StageSink sink(1 << 20, &wakeup, &counters);
  const auto emit = [&](Stage stage, EventKind kind, auto code) {
    Event event;
    event.stage = stage;
    event.kind = kind;
    event.code = static_cast<std::uint8_t>(code);
    event.value = 18.0;
    sink.on_event(event);
  };
  const auto leap = static_cast<std::size_t>(Convention::kLeapSeconds);
  const ConventionGauge &once = counters.conventions[leap],
                        &lasting = counters.lasting_conventions[leap];
  emit(Stage::kGnss, EventKind::kConventionSuspect, Convention::kLeapSeconds);
  emit(Stage::kSequencer, EventKind::kConventionSuspect, Convention::kLeapSeconds);
  CHECK(once.milli.get() == 18'000);
  emit(Stage::kGnss, EventKind::kFilterReset, ResetCause::kHeading);
  CHECK(once.void_events.get() == 0);
  CHECK(counters.reset_cause.get() == static_cast<int>(ResetCause::kHeading));
  emit(Stage::kGnss, EventKind::kFilterReset, ResetCause::kTimeBase);
  CHECK(once.void_events.get() == 1);
  CHECK(lasting.void_events.get() == 0);
  emit(Stage::kSequencer, EventKind::kFilterReset, ResetCause::kTimeBase);
  CHECK(lasting.void_events.get() == 1);
  emit(Stage::kGnss, EventKind::kConventionSuspect, Convention::kLeapSeconds);
  CHECK(once.events.get() == 2);
  CHECK(once.void_events.get() == 1);
  CHECK(lasting.events.get() == 1);
  for (const Convention other : {Convention::kMirrored, Convention::kLeverArm,
                                 Convention::kGyroUnit, Convention::kDopplerSign}) {
    emit(Stage::kGnss, EventKind::kConventionSuspect, other);
    emit(Stage::kGnss, EventKind::kFilterReset, ResetCause::kTimeBase);
    CHECK(counters.conventions[static_cast<std::size_t>(other)].void_events.get() == 0);
  }
}
