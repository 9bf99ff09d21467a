#include "core/robust/igg3.h"

#include <cmath>
#include <limits>

#include "support/catch.h"

using leonav::igg3_factor;

TEST_CASE("IGG-III factor at values worked out by hand") {
  CHECK(igg3_factor(0.0, 1.5, 5.0) == 1.0);
  CHECK(igg3_factor(-1.5, 1.5, 5.0) == 1.0);
  // v = 3: (1.5 / 3) ((5 - 3) / 3.5)^2 = 0.5 * 0.326530612
  CHECK(igg3_factor(3.0, 1.5, 5.0) == Approx(0.163265306).epsilon(1e-8));
  CHECK(igg3_factor(-3.0, 1.5, 5.0) == igg3_factor(3.0, 1.5, 5.0));
  // v = 2, k0 = 1, k1 = 3: (1 / 2) (1 / 2)^2
  CHECK(igg3_factor(2.0, 1.0, 3.0) == Approx(0.125));
  CHECK(igg3_factor(5.0, 1.5, 5.0) == 0.0);
  CHECK(igg3_factor(1e300, 1.5, 5.0) == 0.0);
}

TEST_CASE("IGG-III factor is continuous, falls, and lets nothing absurd through") {
  double previous = 1.0;
  for (double v = 0.0; v < 6.0; v += 0.001) {
    const double factor = igg3_factor(v, 1.5, 5.0);
    CHECK(factor <= previous);
    CHECK(previous - factor < 3e-3);
    previous = factor;
  }
  CHECK(igg3_factor(std::numeric_limits<double>::quiet_NaN(), 1.5, 5.0) == 0.0);
  CHECK(igg3_factor(std::numeric_limits<double>::infinity(), 1.5, 5.0) == 0.0);
  CHECK(igg3_factor(2.0, 1.5, 1.5) == 0.0);  // no fall between equal limits: a plain gate
}
