// How long a reflection lasts, for the orbits of real constellations.
#include "core/filter/error_model/reflection_time.h"

#include <cmath>

#include "support/catch.h"

using namespace leonav;

TEST_CASE("a reflection lasts for seconds from low orbit, for minutes from medium orbit") {
  // Overhead the direction turns by speed over height.
  CHECK(longest_reflection_s(7'350.0 / 970e3) == Approx(4.6).epsilon(0.02));
  CHECK(longest_reflection_s(7'600.0 / 550e3) == Approx(2.5).epsilon(0.02));
  CHECK(longest_reflection_s(3'190.0 / 20'200e3) > 200.0);
  CHECK(std::isinf(longest_reflection_s(0.0)));
}
