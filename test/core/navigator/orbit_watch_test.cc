#include "core/navigator/orbit_watch.h"

#include "support/catch.h"

namespace leonav {

TEST_CASE("a satellite that loses its precise state is noticed once, each by itself") {
  OrbitWatch watch;
  const SatelliteId a{System::kGps, 5}, b{System::kLeo, 399};
  using enum OrbitSource;
  CHECK_FALSE(watch.falls_back(a, kBroadcast));  // it never had one
  CHECK_FALSE(watch.falls_back(a, kPrecise));
  CHECK_FALSE(watch.falls_back(b, kBroadcast));
  CHECK_FALSE(watch.falls_back(a, kNone));  // out of view for a while
  CHECK(watch.falls_back(a, kBroadcast));
  CHECK_FALSE(watch.falls_back(a, kBroadcast));
  CHECK_FALSE(watch.falls_back(a, kPrecise));
  CHECK_FALSE(watch.falls_back(b, kPrecise));
  CHECK(watch.falls_back(a, kBroadcast));
  CHECK(watch.falls_back(b, kBroadcast));
  CHECK_FALSE(watch.falls_back({System::kGps, 1000}, kPrecise));
  CHECK_FALSE(watch.falls_back({System::kGps, 1000}, kBroadcast));
}

}  // namespace leonav
