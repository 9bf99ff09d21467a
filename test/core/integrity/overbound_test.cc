#include "core/integrity/overbound.h"

#include <cmath>
#include <numbers>

#include "normal_overbound.h"
#include "support/catch.h"

using leonav::exceedance;
using leonav::Overbound;
using leonav::test::kNormal;

namespace {

// The density of a normal distribution.
double density(double x, double sigma) {
  return std::exp(-0.5 * x * x / (sigma * sigma)) / (sigma * std::sqrt(2.0 * std::numbers::pi));
}

// Integrates the density of the mixture beyond `distance`, both sides, by Simpson's rule.
double integrated(double distance, double sigma, const Overbound& bound) {
  const double core = sigma * bound.sigma_factor, tail = core * bound.tail_factor;
  const auto mixture = [&](double x) {
    return (1.0 - bound.tail_share) * density(x, core) + bound.tail_share * density(x, tail);
  };
  constexpr int kSteps = 20000;
  const double step = 12.0 * tail / kSteps;
  double sum = mixture(distance) + mixture(distance + kSteps * step);
  for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * mixture(distance + i * step);
  return 2.0 * sum * step / 3.0;
}

}  // namespace

TEST_CASE("without a tail the exceedance is that of the normal distribution, as tabulated") {
  // Abramowitz and Stegun, table 26.1 and 26.2: 2 Q(x).
  CHECK(exceedance(1.0, 1.0, kNormal) == Approx(0.3173105079).epsilon(1e-9));
  CHECK(exceedance(3.0, 1.0, kNormal) == Approx(0.002699796063).epsilon(1e-9));
  CHECK(exceedance(5.0, 1.0, kNormal) == Approx(5.733031437e-7).epsilon(1e-8));
  CHECK(exceedance(10.0, 2.0, kNormal) == exceedance(5.0, 1.0, kNormal));
}

TEST_CASE("the exceedance of the mixture is the integral of its density") {
  const Overbound bound = {1.3, 0.07, 2.5};
  for (const double distance : {0.1, 1.0, 2.0, 4.0, 8.0, 15.0})
    CHECK(exceedance(distance, 0.8, bound) ==
          Approx(integrated(distance, 0.8, bound)).epsilon(1e-8));
}

TEST_CASE("distances that are not positive are always exceeded, and without sigma others never") {
  const Overbound bound;
  CHECK(exceedance(0.0, 1.0, bound) == 1.0);
  CHECK(exceedance(-3.0, 1.0, bound) == 1.0);
  CHECK(exceedance(-3.0, 0.0, bound) == 1.0);
  CHECK(exceedance(1e-9, 0.0, bound) == 0.0);
  CHECK(exceedance(1e-300, 1.0, bound) == Approx(1.0));
}
