#include "core/filter/whole_cycles.h"

#include <cmath>
#include <random>

#include "support/catch.h"

using namespace leonav;

namespace {

constexpr double kSigma = 0.02;  // cycles

// Likelihood ratio of a part of a cycle: its normal density over the uniform one.
double ratio_of(double part) {
  return std::exp(-0.5 * part * part / (kSigma * kSigma)) / (std::sqrt(2.0 * M_PI) * kSigma);
}

// The share learned from arcs of which `whole` differ by whole cycles, the others by any length.
double learned(double whole, int arcs) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, kSigma);
  std::uniform_real_distribution<double> part(-0.5, 0.5), draw(0.0, 1.0);
  WholeCycles cycles;
  for (int i = 0; i < arcs; ++i)
    cycles.learn(ratio_of(draw(random) < whole ? normal(random) : part(random)));
  return cycles.share();
}

}  // namespace

TEST_CASE("the share of arcs that differ by whole cycles is learned") {
  CHECK(WholeCycles().share() == 0.5);
  CHECK(learned(1.0, 400) > 0.97);
  CHECK(learned(0.5, 400) == Approx(0.5).margin(0.08));
  CHECK(learned(0.0, 400) < 0.06);
}

TEST_CASE("a share is known as well as its pairs of arcs are many") {
  CHECK(learned(1.0, 3) > 0.6);
  CHECK(learned(1.0, 3) < 0.9);
}

TEST_CASE("pairs of arcs that show nothing teach nothing") {
  WholeCycles cycles;
  for (int i = 0; i < 100; ++i) cycles.learn(1.0);
  CHECK(cycles.share() == Approx(0.5));
  CHECK(WholeCycles::probability(1.0, cycles.share()) == Approx(0.5));
}

TEST_CASE("the share of a receiver is that of its last few hundred pairs, whatever came before") {
  WholeCycles cycles;
  const auto pairs = [&cycles](int count, int wrong_every) {
    for (int i = 1; i <= count; ++i) cycles.learn(i % wrong_every == 0 ? 0.0 : 20.0);
  };
  pairs(100'000, 10);
  CHECK(cycles.share() == Approx(0.9).margin(0.03));
  // From an open road, where nearly all are whole, into a city and back.
  pairs(2'000, 100);
  CHECK(cycles.share() > 0.97);
  pairs(100, 2);
  CHECK(cycles.share() < 0.85);
  pairs(600, 2);
  CHECK(cycles.share() == Approx(0.5).margin(0.06));
  pairs(1'000, 1'001);
  CHECK(cycles.share() > 0.97);
}
