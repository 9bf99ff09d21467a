#include "core/navigator/monitors/orbit_error_monitor.h"

#include "support/catch.h"

using namespace leonav;

TEST_CASE("an orbit error is reported once, when it doubles, and when it comes back") {
  OrbitErrorMonitor monitor;
  CHECK_FALSE(monitor.add({0.0, 0.0, 0.0, 0.0}));
  const auto first = monitor.add({0.0, 5.0, 0.0, 0.0});
  REQUIRE(first);
  CHECK(first->system == System::kGalileo);
  CHECK(first->range_sigma_m == 5.0);
  CHECK_FALSE(monitor.add({0.0, 9.0, 0.0, 0.0}));
  const auto grown = monitor.add({0.0, 11.0, 0.0, 0.0});
  REQUIRE(grown);
  CHECK(grown->range_sigma_m == 11.0);
  CHECK_FALSE(monitor.add({0.0, 0.0, 0.0, 0.0}));
  CHECK(monitor.add({0.0, 5.0, 0.0, 0.0}));
}

TEST_CASE("of several systems the largest error is reported first, the others in the next epochs") {
  OrbitErrorMonitor monitor;
  CHECK(monitor.add({5.0, 9.0, 7.0, 0.0})->system == System::kGalileo);
  CHECK(monitor.add({5.0, 9.0, 7.0, 0.0})->system == System::kBeidou);
  CHECK(monitor.add({5.0, 9.0, 7.0, 0.0})->system == System::kGps);
  CHECK_FALSE(monitor.add({5.0, 9.0, 7.0, 0.0}));
}
