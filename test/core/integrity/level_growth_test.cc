#include "core/integrity/level_growth.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <random>
#include <vector>

#include "support/catch.h"

using namespace leonav;

namespace {

NominalError random_error(std::mt19937_64& generator) {
  std::normal_distribution<double> normal(0.0, 1.0);
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i) = normal(generator);
  NominalError error;
  error.position_covariance_n = root * root.transpose();
  error.heading_variance = std::pow(0.01 * normal(generator), 2);
  return error;
}

std::vector<FaultHypothesis> random_faults(std::mt19937_64& generator, int count) {
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uniform_real_distribution<double> exponent(-7.0, -2.0);
  std::vector<FaultHypothesis> faults(static_cast<std::size_t>(count));
  for (FaultHypothesis& fault : faults) {
    fault.probability = std::pow(10.0, exponent(generator));
    for (int i = 0; i < 3; ++i) fault.separation_n[i] = 3.0 * normal(generator);
    fault.separation_covariance_n = random_error(generator).position_covariance_n;
    fault.heading_separation = 0.02 * normal(generator);
    fault.heading_separation_variance = std::pow(0.02 * normal(generator), 2);
  }
  return faults;
}

// The error after the inertial navigation has added to it.
NominalError grown(const NominalError& error, const NominalError& by, double factor) {
  NominalError now = error;
  now.position_covariance_n += factor * by.position_covariance_n;
  now.heading_variance += factor * by.heading_variance;
  return now;
}

}  // namespace

TEST_CASE("without faults the levels grow as the sigmas do") {
  std::mt19937_64 generator(1);
  const NominalError epoch = random_error(generator);
  const LevelGrowth growth(epoch, {}, IntegrityConfig());
  const ProtectionLevels before = growth.at(epoch);
  const ProtectionLevels after = growth.at(grown(epoch, epoch, 3.0));  // twice the sigma
  CHECK(after.horizontal_m == Approx(2.0 * before.horizontal_m).epsilon(1e-8));
  CHECK(after.vertical_m == Approx(2.0 * before.vertical_m).epsilon(1e-8));
  CHECK(after.heading == Approx(2.0 * before.heading).epsilon(1e-8));
}

TEST_CASE("with faults no level falls below that of a new solution, and none is far above") {
  std::mt19937_64 generator(2);
  const IntegrityConfig config;
  double largest_ratio = 0.0;
  for (int run = 0; run < 300; ++run) {
    const NominalError epoch = random_error(generator), noise = random_error(generator);
    const auto faults = random_faults(generator, 1 + run % 20);
    const LevelGrowth growth(epoch, faults, config);
    for (const double factor : {0.0, 0.01, 0.3, 1.0, 10.0}) {
      const NominalError now = grown(epoch, noise, factor);
      const ProtectionLevels carried = growth.at(now),
                             solved = protection_levels(now, faults, config);
      // The axes of the ellipse may have turned; the vertical is the same.
      REQUIRE(carried.vertical_m >= solved.vertical_m * (1.0 - 1e-8));
      REQUIRE(carried.heading >= solved.heading * (1.0 - 1e-8));
      largest_ratio = std::max(largest_ratio, carried.vertical_m / solved.vertical_m);
    }
  }
  CHECK(largest_ratio < 2.0);
}

TEST_CASE("drawn errors stay within carried horizontal levels") {
  constexpr double kRisk = 0.02;
  constexpr int kDraws = 200'000;
  IntegrityConfig config;
  config.risk_per_hour = kRisk;
  config.error_correlation_s = 3600.0;
  config.overbound = {1.0, 0.0, 1.0};
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (int run = 0; run < 5; ++run) {
    const NominalError epoch = random_error(generator);
    // Growth along one direction turns the ellipse.
    NominalError noise;
    noise.position_covariance_n(run % 2, run % 2) = 20.0;
    const NominalError now = grown(epoch, noise, 1.0);
    const double level = LevelGrowth(epoch, {}, config).at(now).horizontal_m;
    const Eigen::Matrix3d root = now.position_covariance_n.llt().matrixL();
    int beyond = 0;
    for (int i = 0; i < kDraws; ++i) {
      Eigen::Vector3d unit;
      for (int axis = 0; axis < 3; ++axis) unit[axis] = normal(generator);
      beyond += (root * unit).head<2>().norm() > level ? 1 : 0;
    }
    CHECK(static_cast<double>(beyond) / kDraws <= kRisk + 3.0 * std::sqrt(kRisk / kDraws));
  }
}

TEST_CASE("a sigma that shrinks lowers no level, and no epoch gives no level") {
  std::mt19937_64 generator(4);
  const NominalError epoch = random_error(generator);
  const auto faults = random_faults(generator, 3);
  const LevelGrowth growth(epoch, faults, IntegrityConfig());
  NominalError smaller = epoch;
  smaller.position_covariance_n *= 0.25;
  smaller.heading_variance *= 0.25;
  CHECK(growth.at(smaller).horizontal_m == growth.at(epoch).horizontal_m);
  CHECK(growth.at(smaller).vertical_m == growth.at(epoch).vertical_m);
  CHECK(std::isnan(LevelGrowth().at(epoch).horizontal_m));
  CHECK(std::isnan(LevelGrowth().at(epoch).vertical_m));
  CHECK(std::isnan(LevelGrowth().at(epoch).heading));
}

TEST_CASE("more hypotheses than there is room for do no harm") {
  std::mt19937_64 generator(6);
  const NominalError epoch = random_error(generator);
  const auto faults = random_faults(generator, kMaxFaultHypotheses + 5);
  CHECK(LevelGrowth(epoch, faults, IntegrityConfig()).at(epoch).vertical_m > 0.0);
}
