// How long HEALTH keeps a convention that was broken.
#include "daemon/health/internal/convention_monitor.h"

#include <array>
#include <string>

#include "support/catch.h"

namespace {

using namespace leonav;

void tell(EngineCounters* counters, Convention convention, double value, bool comes_again = true) {
  const auto i = static_cast<std::size_t>(convention);
  auto& gauges = comes_again ? counters->lasting_conventions : counters->conventions;
  gauges[i].milli.set(static_cast<std::int64_t>(1e3 * value));
  gauges[i].events.add(1);
}

// What a StageSink does at a time step with what stamps can look like.
void void_all(std::array<ConventionGauge, kConventionCount>* gauges) {
  for (ConventionGauge& gauge : *gauges) gauge.void_events.set(gauge.events.get());
}

}  // namespace

TEST_CASE("stamps that have come right are forgotten after two minutes, axes never") {
  EngineCounters counters;
  ConventionMonitor monitor(&counters);
  CHECK(monitor.look(0.0).empty());
  tell(&counters, Convention::kLeapSeconds, 18.0);
  CHECK(monitor.look(1.0).size() == 1);
  const std::string told = monitor.suspicions();
  CHECK(told.find("18") != std::string::npos);
  // Found again with a slightly other value: the same text.
  tell(&counters, Convention::kLeapSeconds, 17.98);
  CHECK(monitor.look(61.0).size() == 1);
  CHECK(monitor.suspicions() == told);
  CHECK(monitor.look(181.0).size() == 1);
  CHECK(monitor.look(182.0).empty());
  // What is told but once, stamps as well, stays.
  for (const Convention once : {Convention::kMirrored, Convention::kLeapSeconds}) {
    EngineCounters others;
    ConventionMonitor watch(&others);
    tell(&others, once, 18.0, false);
    CHECK(watch.look(183.0).size() == 1);
    CHECK(watch.look(100'000.0).size() == 1);
  }
}

TEST_CASE("a time step of the inputs ends what the stage had found, until it finds it again") {
  for (const bool comes_again : {false, true}) {
    CAPTURE(comes_again);
    EngineCounters counters;
    ConventionMonitor monitor(&counters);
    tell(&counters, Convention::kStampOffset, -3.0, comes_again);
    CHECK(monitor.look(1.0).size() == 1);
    // The other stage's time step says nothing about it.
    void_all(comes_again ? &counters.conventions : &counters.lasting_conventions);
    CHECK(monitor.look(2.0).size() == 1);
    void_all(comes_again ? &counters.lasting_conventions : &counters.conventions);
    CHECK(monitor.look(3.0).empty());
    CHECK(monitor.suspicions().empty());
    CHECK(monitor.look(4.0).empty());
    tell(&counters, Convention::kStampOffset, -25.0, comes_again);
    CHECK(monitor.look(5.0).size() == 1);
    CHECK(monitor.suspicions().find("25") != std::string::npos);
  }
}

TEST_CASE("what was found and ended by a time step between two looks is never told") {
  EngineCounters counters;
  ConventionMonitor monitor(&counters);
  tell(&counters, Convention::kStampOffset, 25.0, false);
  void_all(&counters.conventions);
  CHECK(monitor.look(1.0).empty());
}
