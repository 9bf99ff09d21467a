// What a stage's epochs leave for HEALTH.
#include "daemon/stage_sink.h"

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
