// How long a reflection lasts and how its carrier drifts, for the orbits of real constellations.
#include "core/filter/error_model/reflection.h"

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

// A satellite in a circular orbit whose plane contains the antenna's vertical, above a flat Earth.
// The wall is vertical and 10 m away; what it reflects arrives as at the antenna's mirror image.
TEST_CASE("the carrier of a mirrored antenna drifts by no more than the random walk allows") {
  struct Orbit {
    double height_m, speed_m_s;
  };
  const Orbit orbit =
      GENERATE(Orbit{970e3, 7'350.0}, Orbit{550e3, 7'600.0}, Orbit{20'200e3, 3'190.0});
  const double to_wall_m = 10.0, duration_s = 10.0;
  const auto detour = [&](double t) {  // at t = 0 in the zenith; the wall faces the orbit
    const double x = orbit.speed_m_s * t;
    return std::hypot(x + 2.0 * to_wall_m, orbit.height_m) - std::hypot(x, orbit.height_m);
  };
  double drifts = 0.0, allowed = 0.0;
  for (int i = -100; i <= 100; ++i) {  // up to 45 degrees from the zenith
    const double t = 0.01 * i * orbit.height_m / orbit.speed_m_s;
    const double distance_squared =
        std::pow(orbit.speed_m_s * t, 2.0) + std::pow(orbit.height_m, 2.0);
    const double rate = orbit.speed_m_s * orbit.height_m / distance_squared;
    const double drift = detour(t + duration_s) - detour(t);
    const double sigma =
        reflected_random_walk(2.0 * to_wall_m, rate, duration_s) * std::sqrt(duration_s);
    CHECK(std::abs(drift) < 1.5 * sigma);
    drifts += drift * drift;
    allowed += sigma * sigma;
  }
  CHECK(drifts > 0.3 * allowed);
}
