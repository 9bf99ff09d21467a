#include "core/navigator/orbit_watch.h"

#include "support/catch.h"

namespace leonav {

TEST_CASE("a satellite whose orbit's source changes is noticed once, each by itself") {
  OrbitWatch watch;
  const SatelliteId a{System::kGps, 5}, b{System::kLeo, 399};
  using enum OrbitSource;
  CHECK(watch.look(a, kBroadcast, false) == OrbitChange::kNone);
  CHECK(watch.look(a, kPrecise, false) == OrbitChange::kReturn);  // it never had one
  CHECK(watch.look(a, kPrecise, false) == OrbitChange::kNone);
  CHECK(watch.look(b, kBroadcast, false) == OrbitChange::kNone);
  CHECK(watch.look(a, kNone, false) == OrbitChange::kNone);  // out of view for a while
  CHECK(watch.look(a, kBroadcast, false) == OrbitChange::kFallback);
  CHECK(watch.look(a, kBroadcast, false) == OrbitChange::kNone);
  CHECK(watch.look(a, kNone, false) == OrbitChange::kNone);
  CHECK(watch.look(a, kPrecise, false) == OrbitChange::kReturn);
  CHECK(watch.look(b, kPrecise, false) == OrbitChange::kReturn);
  CHECK(watch.look(a, kBroadcast, false) == OrbitChange::kFallback);
  CHECK(watch.look(b, kBroadcast, false) == OrbitChange::kFallback);
  CHECK(watch.look({System::kGps, 1000}, kPrecise, false) == OrbitChange::kNone);
  CHECK(watch.look({System::kGps, 1000}, kBroadcast, false) == OrbitChange::kNone);
}

TEST_CASE("a precise clock that comes from another file is noticed") {
  OrbitWatch watch;
  const SatelliteId a{System::kGps, 5};
  using enum OrbitSource;
  CHECK(watch.look(a, kPrecise, true) == OrbitChange::kNone);
  CHECK(watch.look(a, kPrecise, false) == OrbitChange::kClockFallback);
  CHECK(watch.look(a, kPrecise, false) == OrbitChange::kNone);
  CHECK(watch.look(a, kNone, false) == OrbitChange::kNone);
  CHECK(watch.look(a, kPrecise, true) == OrbitChange::kClockReturn);
  CHECK(watch.look(a, kBroadcast, false) == OrbitChange::kFallback);  // one change, told once
  CHECK(watch.look(a, kPrecise, true) == OrbitChange::kReturn);
}

TEST_CASE("a satellite first seen by precise states is no change") {
  OrbitWatch watch;
  const SatelliteId a{System::kGps, 5};
  CHECK(watch.look(a, OrbitSource::kPrecise, false) == OrbitChange::kNone);
  CHECK(watch.look(a, OrbitSource::kPrecise, false) == OrbitChange::kNone);
}

}  // namespace leonav
