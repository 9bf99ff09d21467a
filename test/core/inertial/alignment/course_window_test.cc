#include "core/inertial/alignment/course_window.h"
#include "core/base/angle.h"

#include <cmath>
#include <random>

#include "support/catch.h"

using namespace leonav;

TEST_CASE("Courses that agree across the seam at 180 degrees", "[ins]") {
  CourseWindow window(3.0);
  for (int i = 0; i < 4; ++i) {
    CHECK_FALSE(window.agreement());
    // The gyros' heading turns through many rounds; the course, wrapped, turns with it.
    const double yaw = 5.0 * i;
    window.add({static_cast<double>(i), std::remainder(yaw + 3.1 + (i % 2 ? 0.1 : -0.1), 2.0 * kPi),
                yaw, 0.02});
  }
  const auto agreement = window.agreement();
  REQUIRE(agreement);
  CHECK(std::remainder(agreement->yaw_offset - 3.1, 2.0 * kPi) == Approx(0.0).margin(1e-9));
  CHECK(agreement->sigma == Approx(std::hypot(0.1, 0.02)).epsilon(0.01));
}

TEST_CASE("The stated sigma covers correlated course errors", "[ins]") {
  // A course error that lasts as long as the window (2 s correlation): sigma must not shrink.
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  double squared = 0.0;
  int count = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    CourseWindow window(3.0);
    const double keep = std::exp(-0.25 / 2.0);
    double error = 0.1 * normal(random);
    for (int i = 0; i <= 12; ++i) {
      window.add({0.25 * i, 1.0 + error, 0.0, 0.1});
      const double push = normal(random);
      error = keep * error + 0.1 * std::sqrt(1.0 - keep * keep) * push;
    }
    const auto agreement = window.agreement();
    REQUIRE(agreement);
    squared += std::pow((agreement->yaw_offset - 1.0) / agreement->sigma, 2);
    ++count;
  }
  const double ratio = std::sqrt(squared / count);
  CHECK(ratio < 1.0);
  CHECK(ratio > 0.3);  // honest, not useless
}

TEST_CASE("Opposite courses agree on nothing, fast receivers do not overflow the window", "[ins]") {
  CourseWindow opposite(1.0);
  for (int i = 0; i < 3; ++i)
    opposite.add({i * 0.5, i % 2 ? kPi : 0.0, 0.0, i % 2 ? 0.05 : 0.0707});
  const auto none = opposite.agreement();
  CHECK((!none || none->sigma > 1.0));

  CourseWindow fast(3.0);
  for (int i = 0; i < 100000; ++i) {
    fast.add({i * 0.001, 0.4, 0.1, 0.05});
    if (i == 2900) CHECK_FALSE(fast.agreement());
  }
  REQUIRE(fast.agreement());
  CHECK(fast.agreement()->yaw_offset == Approx(0.3));
  CHECK(fast.agreement()->sigma == Approx(0.05));
  fast.clear();
  CHECK_FALSE(fast.agreement());
}
