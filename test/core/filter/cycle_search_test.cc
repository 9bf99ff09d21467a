#include "core/filter/cycle_search.h"

#include <cmath>
#include <random>

#include "core/base/square.h"
#include "core/gnss/measurement/weighting.h"
#include "gps_pair.h"
#include "support/catch.h"

using namespace leonav;
using test::kL1;
using test::kL2;

namespace {

CycleEquations equations_of(double n1, double n2, double sigma_m, double geometry_free_sigma_m) {
  const IonosphereFree pair = ionosphere_free(kL1, kL2);
  CycleEquations e;
  e.wavelength_m = {kSpeedOfLight / kL1, kSpeedOfLight / kL2};
  e.gamma = {pair.gamma1, pair.gamma2};
  e.difference_m = pair.gamma1 * e.wavelength_m[0] * n1 + pair.gamma2 * e.wavelength_m[1] * n2;
  e.geometry_free_m = e.wavelength_m[0] * n1 - e.wavelength_m[1] * n2;
  e.difference_sigma_m = sigma_m;
  e.geometry_free_sigma_m = geometry_free_sigma_m;
  return e;
}

}  // namespace

TEST_CASE("the search finds what brute force over a big box finds") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> cycles(-40, 40);
  for (int round = 0; round < 50; ++round) {
    CAPTURE(round);
    CycleEquations e = equations_of(cycles(random), cycles(random), 0.15, 0.012);
    e.difference_m += 0.15 * normal(random);
    e.geometry_free_m += 0.012 * normal(random);
    double best = INFINITY, best_1 = 0.0, best_2 = 0.0, sum = 0.0;
    double second = INFINITY, best_m = 0.0, second_m = 0.0;
    for (int n1 = -300; n1 <= 300; ++n1)
      for (int n2 = -300; n2 <= 300; ++n2) {
        const double x = n1 * e.wavelength_m[0], y = n2 * e.wavelength_m[1];
        const double chi_square =
            square((e.difference_m - e.gamma[0] * x - e.gamma[1] * y) / e.difference_sigma_m) +
            square((e.geometry_free_m - x + y) / e.geometry_free_sigma_m);
        sum += std::exp(-0.5 * chi_square);
        const double length_m = e.gamma[0] * x + e.gamma[1] * y;
        if (chi_square >= best && chi_square < second) {
          second = chi_square;
          second_m = length_m;
        }
        if (chi_square >= best) continue;
        second = best;
        second_m = best_m;
        best_m = length_m;
        best = chi_square;
        best_1 = n1;
        best_2 = n2;
      }
    const CycleSearch search = search_cycles(e);
    REQUIRE(search.found);
    CHECK(search.cycles[0] == best_1);
    CHECK(search.cycles[1] == best_2);
    CHECK(search.chi_square == Approx(best).margin(1e-6));
    CHECK(search.alternative_m > 0.0);
    if (second < 20.0)  // within five sigmas of each equation
      CHECK(search.alternative_m == Approx(std::abs(second_m - best_m)).margin(1e-6));
    // What lies outside five sigmas is not counted.
    CHECK(search.wrong_probability == Approx(1.0 - std::exp(-0.5 * best) / sum).margin(2e-5));
    CHECK(search.likelihood_ratio == Approx(search.sharpness * sum).epsilon(1e-4));
  }
}

TEST_CASE("cycles are certain or not by the sigma of the difference") {
  CHECK(search_cycles(equations_of(-178806, 15484, 0.05, 0.01)).wrong_probability < 1e-4);
  CHECK(search_cycles(equations_of(3, -2, 0.6, 0.02)).wrong_probability > 1e-3);
  CHECK_FALSE(search_cycles(equations_of(3, -2, 100.0, 0.01)).found);  // too many to decide
}

TEST_CASE("a geometry-free change that no cycles explain is refused") {
  CycleEquations e = equations_of(5, 4, 0.03, 0.003);
  e.geometry_free_m += 0.02;
  const CycleSearch search = search_cycles(e);
  CHECK((!search.found || search.chi_square > 13.8));
}

TEST_CASE("the likelihood ratio is one on average over differences of any length") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> length(-50.0, 50.0);
  for (const double second : {0.0, kSpeedOfLight / kL2}) {
    double mean = 0.0;
    constexpr int kDraws = 20000;
    for (int i = 0; i < kDraws; ++i) {
      CycleEquations e = equations_of(0.0, 0.0, 0.03, 0.03);
      e.wavelength_m[1] = second;
      if (second == 0.0) e.gamma = {1.0, 0.0};
      e.difference_m = length(random);
      e.geometry_free_m = length(random);
      const CycleSearch search = search_cycles(e);
      CHECK(search.sharpness > 2.0);
      mean += search.likelihood_ratio / kDraws;
    }
    CHECK(mean == Approx(1.0).margin(0.05));
  }
}

TEST_CASE("on one frequency the difference alone decides") {
  CycleEquations e;
  e.wavelength_m = {kSpeedOfLight / kL1, 0.0};
  e.difference_m = 12.0 * e.wavelength_m[0] + 0.01;
  e.difference_sigma_m = 0.02;
  const CycleSearch search = search_cycles(e);
  REQUIRE(search.found);
  CHECK(search.cycles[0] == 12.0);
  CHECK(search.length_m == Approx(12.0 * e.wavelength_m[0]));
  CHECK(search.wrong_probability < 1e-4);
  e.difference_sigma_m = 0.08;
  CHECK(search_cycles(e).wrong_probability > 1e-2);
}
