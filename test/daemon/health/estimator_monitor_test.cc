// What HEALTH makes of an estimator that starts over, jumps or meets what it did not expect.
#include "daemon/health/internal/estimator_monitor.h"

#include "core/navigator/interface/solution.h"
#include "support/catch.h"

namespace {

using namespace leonav;

void set_source(Source source, EngineCounters* counters) {
  counters->source.set(static_cast<std::int64_t>(source));
}

void start_over(ResetCause cause, EngineCounters* counters) {
  counters->reset_cause.set(static_cast<std::int64_t>(cause));
  counters->filter_starts.add(1);
}

}  // namespace

TEST_CASE("a filter that starts over again is told with the last cause") {
  EngineCounters counters;
  EstimatorMonitor monitor(&counters);
  start_over(ResetCause::kOutage, &counters);
  start_over(ResetCause::kLockedOut, &counters);
  REQUIRE(monitor.look().size() == 1);
  CHECK(monitor.look().empty());
  start_over(ResetCause::kOutage, &counters);
  const auto found = monitor.look();
  REQUIRE(found.size() == 1);
  CHECK(found[0].detail == "an outage has lost the position");
}

TEST_CASE(
    "a filter that starts over raises its reason at one look, and waits until two epochs have "
    "come") {
  EngineCounters counters;
  EstimatorMonitor monitor(&counters);
  counters.accepted_epochs.set(100);
  CHECK(monitor.look().empty());
  CHECK_FALSE(monitor.waits_for_epoch());
  start_over(ResetCause::kHeading, &counters);
  const auto found = monitor.look();
  REQUIRE(found.size() == 1);
  CHECK(found[0].reason == HealthReason::kFilterStartedOver);
  CHECK(found[0].detail == "the heading contradicts the motion");
  CHECK(monitor.waits_for_epoch());
  counters.accepted_epochs.set(101);  // may be on its way
  CHECK(monitor.look().empty());
  CHECK(monitor.waits_for_epoch());
  counters.accepted_epochs.set(102);
  CHECK_FALSE(monitor.waits_for_epoch());
}

TEST_CASE("jumps are a reason after thirty looks with an answer, and not before") {
  EngineCounters counters;
  EstimatorMonitor monitor(&counters);
  set_source(Source::kEkf, &counters);
  for (int look = 1; look <= 30; ++look) {
    counters.large_jumps.add(1);
    CHECK(monitor.look().empty());
  }
  CHECK(monitor.look().empty());
  counters.large_jumps.add(1);
  REQUIRE(monitor.look().size() == 1);
  CHECK(monitor.look().empty());
}

TEST_CASE("after an outage only a jump that the sigma did not foresee is a reason") {
  EngineCounters counters;
  EstimatorMonitor monitor(&counters);
  set_source(Source::kEkf, &counters);
  for (int look = 1; look <= 30; ++look) CHECK(monitor.look().empty());
  set_source(Source::kInsOnly, &counters);
  CHECK(monitor.look().empty());
  set_source(Source::kSmoother, &counters);
  counters.large_jumps.add(1);
  CHECK(monitor.look().empty());
  counters.large_jumps.add(1);
  counters.surprising_jumps.add(1);
  REQUIRE(monitor.look().size() == 1);

  set_source(Source::kNone, &counters);  // the thirty looks begin again
  CHECK(monitor.look().empty());
  set_source(Source::kInsOnly, &counters);
  counters.large_jumps.add(1);
  counters.surprising_jumps.add(1);
  CHECK(monitor.look().empty());
}

TEST_CASE("a prediction that is contradicted once is no reason, twice within ten looks is") {
  EngineCounters counters;
  EstimatorMonitor monitor(&counters);
  for (int look = 0; look < 20; ++look) {
    if (look % 10 == 0) counters.widened_predictions.add(1);
    CHECK(monitor.look().empty());
  }
  counters.widened_predictions.add(2);  // codes and Dopplers of one epoch
  CHECK(monitor.look().empty());
  counters.widened_predictions.add(1);
  REQUIRE(monitor.look().size() == 1);
}

TEST_CASE("each surprise of the estimator is a finding of its own") {
  EngineCounters counters;
  EstimatorMonitor monitor(&counters);
  counters.widened_predictions.add(1);
  CHECK(monitor.look().empty());
  counters.widened_predictions.add(1);
  counters.events[static_cast<std::size_t>(EventKind::kImprobable)].add(1);
  counters.events[static_cast<std::size_t>(EventKind::kConstraintsLeftOut)].add(1);
  const auto found = monitor.look();
  REQUIRE(found.size() == 3);
  CHECK(found[0].reason == HealthReason::kPredictionWidened);
  CHECK(found[1].reason == HealthReason::kImprobable);
  CHECK(found[2].reason == HealthReason::kConstraintsLeftOut);
  const auto later = monitor.look();
  REQUIRE(later.size() == 1);
  CHECK(later[0].reason == HealthReason::kPredictionWidened);  // within ten looks
}
