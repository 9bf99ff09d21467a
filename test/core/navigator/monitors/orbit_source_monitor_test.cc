#include "core/navigator/monitors/orbit_source_monitor.h"

#include "support/catch.h"

namespace leonav {

TEST_CASE("a satellite whose orbit's source changes is noticed once, each by itself") {
  OrbitSourceMonitor watch;
  const SatelliteId a{System::kGps, 5}, b{System::kLeo, 399};
  using enum OrbitSource;
  CHECK(watch.update(a, kBroadcast, false) == OrbitChange::kNone);
  CHECK(watch.update(a, kPrecise, false) == OrbitChange::kReturn);  // it never had one
  CHECK(watch.update(a, kPrecise, false) == OrbitChange::kNone);
  CHECK(watch.update(b, kBroadcast, false) == OrbitChange::kNone);
  CHECK(watch.update(a, kNone, false) == OrbitChange::kNone);  // out of view for a while
  CHECK(watch.update(a, kBroadcast, false) == OrbitChange::kFallback);
  CHECK(watch.update(a, kBroadcast, false) == OrbitChange::kNone);
  CHECK(watch.update(a, kNone, false) == OrbitChange::kNone);
  CHECK(watch.update(a, kPrecise, false) == OrbitChange::kReturn);
  CHECK(watch.update(b, kPrecise, false) == OrbitChange::kReturn);
  CHECK(watch.update(a, kBroadcast, false) == OrbitChange::kFallback);
  CHECK(watch.update(b, kBroadcast, false) == OrbitChange::kFallback);
  CHECK(watch.update({System::kGps, 1000}, kPrecise, false) == OrbitChange::kNone);
  CHECK(watch.update({System::kGps, 1000}, kBroadcast, false) == OrbitChange::kNone);
}

TEST_CASE("a precise clock that comes from another file is noticed") {
  OrbitSourceMonitor watch;
  const SatelliteId a{System::kGps, 5};
  using enum OrbitSource;
  CHECK(watch.update(a, kPrecise, true) == OrbitChange::kNone);
  CHECK(watch.update(a, kPrecise, false) == OrbitChange::kClockFallback);
  CHECK(watch.update(a, kPrecise, false) == OrbitChange::kNone);
  CHECK(watch.update(a, kNone, false) == OrbitChange::kNone);
  CHECK(watch.update(a, kPrecise, true) == OrbitChange::kClockReturn);
  CHECK(watch.update(a, kBroadcast, false) == OrbitChange::kFallback);  // one change, told once
  CHECK(watch.update(a, kPrecise, true) == OrbitChange::kReturn);
}

TEST_CASE("a satellite first seen by precise states is no change") {
  OrbitSourceMonitor watch;
  const SatelliteId a{System::kGps, 5};
  CHECK(watch.update(a, OrbitSource::kPrecise, false) == OrbitChange::kNone);
  CHECK(watch.update(a, OrbitSource::kPrecise, false) == OrbitChange::kNone);
}

}  // namespace leonav
