#include "core/navigator/orbit_watch.h"

#include "support/catch.h"

namespace leonav {

TEST_CASE("a satellite whose orbit's source changes is noticed once, each by itself") {
  OrbitWatch watch;
  const SatelliteId a{System::kGps, 5}, b{System::kLeo, 399};
  using enum OrbitSource;
  CHECK(watch.look(a, kBroadcast) == OrbitChange::kNone);
  CHECK(watch.look(a, kPrecise) == OrbitChange::kReturn);  // it never had one
  CHECK(watch.look(a, kPrecise) == OrbitChange::kNone);
  CHECK(watch.look(b, kBroadcast) == OrbitChange::kNone);
  CHECK(watch.look(a, kNone) == OrbitChange::kNone);  // out of view for a while
  CHECK(watch.look(a, kBroadcast) == OrbitChange::kFallback);
  CHECK(watch.look(a, kBroadcast) == OrbitChange::kNone);
  CHECK(watch.look(a, kNone) == OrbitChange::kNone);
  CHECK(watch.look(a, kPrecise) == OrbitChange::kReturn);
  CHECK(watch.look(b, kPrecise) == OrbitChange::kReturn);
  CHECK(watch.look(a, kBroadcast) == OrbitChange::kFallback);
  CHECK(watch.look(b, kBroadcast) == OrbitChange::kFallback);
  CHECK(watch.look({System::kGps, 1000}, kPrecise) == OrbitChange::kNone);
  CHECK(watch.look({System::kGps, 1000}, kBroadcast) == OrbitChange::kNone);
}

TEST_CASE("a satellite first seen by precise states is no change") {
  OrbitWatch watch;
  const SatelliteId a{System::kGps, 5};
  CHECK(watch.look(a, OrbitSource::kPrecise) == OrbitChange::kNone);
  CHECK(watch.look(a, OrbitSource::kPrecise) == OrbitChange::kNone);
}

}  // namespace leonav
