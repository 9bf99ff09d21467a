// What HEALTH makes of satellites without orbits and of measurements that contradict.
#include "daemon/health/internal/measurement_monitor.h"

#include <algorithm>

#include "core/navigator/interface/solution.h"
#include "support/catch.h"

namespace {

using namespace leonav;

// Counters as an engine writes them, and what is found in them.
struct WatchedCounters {
  EngineCounters counters;
  MeasurementMonitor monitor{&counters};

  WatchedCounters() { counters.source.set(static_cast<std::int64_t>(Source::kEkf)); }
  void satellites(Reason reason, std::int64_t count) {
    counters.satellites_by_reason[static_cast<std::size_t>(reason)].set(count);
  }
  bool finds(HealthReason reason) {
    const auto found = monitor.look();
    return std::any_of(found.begin(), found.end(),
                       [&](const Finding& one) { return one.reason == reason; });
  }
};

}  // namespace

TEST_CASE("HEALTH tells of satellites without orbits once more than half lack one") {
  WatchedCounters rig;
  rig.satellites(Reason::kUsed, 6);
  rig.satellites(Reason::kNoEphemeris, 4);
  rig.satellites(Reason::kEphemerisTooOld, 2);
  CHECK_FALSE(rig.finds(HealthReason::kWithoutOrbit));
  rig.satellites(Reason::kEphemerisTooOld, 3);
  CHECK(rig.finds(HealthReason::kWithoutOrbit));
  rig.counters.source.set(static_cast<std::int64_t>(Source::kNone));
  CHECK_FALSE(rig.finds(HealthReason::kWithoutOrbit));
}

TEST_CASE("HEALTH tells that precise orbits have ended only where several were in use") {
  WatchedCounters rig;
  rig.counters.satellites_by_source[0].set(8);
  rig.counters.satellites_by_source[1].set(3);
  CHECK_FALSE(rig.finds(HealthReason::kPreciseEnded));
  rig.counters.satellites_by_source[1].set(0);
  CHECK_FALSE(rig.finds(HealthReason::kPreciseEnded));
  rig.counters.satellites_by_source[1].set(4);
  CHECK_FALSE(rig.finds(HealthReason::kPreciseEnded));
  rig.counters.satellites_by_source[1].set(0);
  CHECK(rig.finds(HealthReason::kPreciseEnded));
  rig.counters.satellites_by_source[0].set(0);  // no satellite at all
  CHECK_FALSE(rig.finds(HealthReason::kPreciseEnded));
}

TEST_CASE("HEALTH tells of contradicting measurements for as long as they are more than half") {
  WatchedCounters rig;
  rig.counters.measurements.add(100);
  rig.counters.contradicting_measurements.add(51);
  CHECK(rig.finds(HealthReason::kMostRejected));
  rig.counters.measurements.add(100);  // a second later, all good
  CHECK_FALSE(rig.finds(HealthReason::kMostRejected));
}

TEST_CASE("HEALTH judges no share of fewer than fifty measurements") {
  WatchedCounters rig;
  rig.counters.measurements.add(49);
  rig.counters.contradicting_measurements.add(49);
  CHECK_FALSE(rig.finds(HealthReason::kMostRejected));
  rig.counters.measurements.add(1);
  CHECK(rig.finds(HealthReason::kMostRejected));
}

TEST_CASE("HEALTH tells of refused orbits for as long as satellites are seen that have them") {
  WatchedCounters rig;
  CHECK_FALSE(rig.finds(HealthReason::kOrbitsRefused));
  rig.counters.orbits_refused.set(1);
  CHECK(rig.finds(HealthReason::kOrbitsRefused));
  rig.counters.orbits_refused.set(0);
  CHECK_FALSE(rig.finds(HealthReason::kOrbitsRefused));
}

TEST_CASE("HEALTH names the systems whose codes are off for minutes, and satellites that drift") {
  WatchedCounters rig;
  rig.counters.lasting_cm[0].set(99);
  CHECK(rig.monitor.look().empty());
  rig.counters.lasting_cm[0].set(100);
  rig.counters.lasting_cm[1].set(100);
  const auto found = rig.monitor.look();
  REQUIRE(found.size() == 1);
  CHECK(found[0].reason == HealthReason::kLastingErrors);
  CHECK(found[0].detail == "gps, galileo");
  Gauge& faults = rig.counters.events[static_cast<std::size_t>(EventKind::kSatelliteFault)];
  faults.add(2);
  CHECK_FALSE(rig.finds(HealthReason::kSatellitesDrift));
  faults.add(1);
  CHECK(rig.finds(HealthReason::kSatellitesDrift));
}
