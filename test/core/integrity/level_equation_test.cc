#include "core/integrity/level_equation.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "normal_overbound.h"
#include "support/catch.h"

using namespace leonav;
using test::kNormal;

namespace {

double solve(const std::vector<LevelTerm>& terms, double risk, const Overbound& bound = kNormal) {
  return solve_level(terms, risk, bound);
}

// Draws errors under random hypotheses and returns the share beyond `level`.
double drawn_share(const std::vector<LevelTerm>& terms, double level, const Overbound& bound,
                   int draws) {
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  int beyond = 0;
  for (int i = 0; i < draws; ++i) {
    double choice = uniform(generator);
    std::size_t k = 0;
    while (k + 1 < terms.size() && choice >= terms[k].probability) choice -= terms[k++].probability;
    const bool tail = uniform(generator) < bound.tail_share;
    const double sigma = terms[k].sigma * bound.sigma_factor * (tail ? bound.tail_factor : 1.0);
    const double side = uniform(generator) < 0.5 ? -1.0 : 1.0;
    const double error = side * terms[k].offset + sigma * normal(generator);
    beyond += std::abs(error) > level ? 1 : 0;
  }
  return static_cast<double>(beyond) / draws;
}

}  // namespace

TEST_CASE("the level of one hypothesis is a quantile of the normal distribution") {
  // The inverse of 2 Q, from tables of the normal distribution.
  CHECK(solve({{1.0, 0.0, 1.0}}, 1e-7) == Approx(5.326723886384099).epsilon(1e-9));
  CHECK(solve({{1.0, 0.0, 1.0}}, 1e-5) == Approx(4.417173413469025).epsilon(1e-9));
  CHECK(solve({{1.0, 0.0, 2.0}}, 0.05) == Approx(2.0 * 1.959963984540054).epsilon(1e-9));
  // An offset moves the level, and a smaller prior raises the allowed risk.
  CHECK(solve({{1.0, 3.0, 1.0}}, 1e-7) == Approx(8.326723886384099).epsilon(1e-9));
  CHECK(solve({{1e-4, 3.0, 1.0}}, 1e-7) == Approx(3.0 + 3.290526731491894).epsilon(1e-9));
}

TEST_CASE("the level of several hypotheses with a heavy tail agrees with another solver") {
  // A secant iteration in Python, on Simpson integrals of the densities.
  const std::vector<LevelTerm> terms = {{0.9988, 0.1, 0.5}, {1e-3, 2.0, 0.9}, {2e-4, 6.0, 1.4}};
  CHECK(solve(terms, 1e-6, {1.2, 0.05, 3.0}) == Approx(14.308229488359947).epsilon(1e-8));
}

TEST_CASE("drawn errors exceed the level as often as the risk allows, and no more") {
  const std::vector<LevelTerm> terms = {{0.9, 0.0, 1.0}, {0.07, 4.0, 1.5}, {0.03, 9.0, 2.0}};
  const Overbound bound = {1.0, 0.1, 3.0};
  constexpr double kRisk = 0.01;
  constexpr int kDraws = 1'000'000;
  const double share = drawn_share(terms, solve(terms, kRisk, bound), bound, kDraws);
  const double three_sigma = 3.0 * std::sqrt(kRisk / kDraws);
  // The equation counts both sides of an offset, of which one lies far inside the level.
  CHECK(share <= kRisk + three_sigma);
  CHECK(share >= 0.5 * kRisk);
}

TEST_CASE("without offsets drawn errors use the risk up") {
  const std::vector<LevelTerm> terms = {{0.9, 0.0, 1.0}, {0.1, 0.0, 3.0}};
  constexpr double kRisk = 0.01;
  constexpr int kDraws = 1'000'000;
  const double share = drawn_share(terms, solve(terms, kRisk), kNormal, kDraws);
  CHECK(share == Approx(kRisk).margin(3.0 * std::sqrt(kRisk / kDraws)));
}

TEST_CASE("the remaining risk falls with the level and is used up at the solution") {
  const std::vector<LevelTerm> terms = {{0.99, 0.0, 0.7}, {0.01, 5.0, 1.0}};
  double previous = 2.0;
  for (double level = 0.0; level < 12.0; level += 0.01) {
    const double risk = remaining_risk(level, terms, kNormal);
    REQUIRE(risk <= previous);
    previous = risk;
  }
  const double level = solve(terms, 1e-5);
  CHECK(remaining_risk(level, terms, kNormal) <= 1e-5);
  CHECK(remaining_risk(level * (1.0 - 2e-9), terms, kNormal) > 1e-5);
}

TEST_CASE("the level knows certainty, any risk, and numbers that are none") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(solve({{1.0, 0.0, 0.0}}, 1e-7) < 1e-300);
  CHECK(solve({{1.0, 2.0, 0.0}}, 1e-7) == Approx(2.0).epsilon(2e-9));
  CHECK(solve({{1.0, 0.0, 1.0}}, 1.0) == 0.0);
  CHECK(solve({{1.0, 0.0, 1.0}}, 1e-300) == Approx(37.0).margin(0.3));
  CHECK(std::isnan(solve({{1.0, 0.0, nan}}, 1e-7)));
  CHECK(std::isnan(solve({{1.0, nan, 1.0}}, 1e-7)));
  CHECK(std::isnan(solve({{1.0, 0.0, 1.0}}, 0.0)));
  CHECK(std::isnan(solve({{1.0, 0.0, 1.0}}, nan)));
}
