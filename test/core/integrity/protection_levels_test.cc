#include "core/integrity/protection_levels.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "support/catch.h"

using namespace leonav;

namespace {

// One sample an hour, so that the risk per hour is that of one estimate, and normal errors.
IntegrityConfig normal_errors(double risk) {
  IntegrityConfig config;
  config.risk_per_hour = risk;
  config.error_correlation_s = 3600.0;
  config.overbound = {1.0, 0.0, 1.0};
  return config;
}

// The upper tail of the standard normal distribution is half of `risk_of_both` there.
double quantile(double risk_of_both) {
  double low = 0.0, high = 40.0;
  while (high - low > 1e-12)
    (std::erfc(0.5 * (low + high) / std::numbers::sqrt2) > risk_of_both ? low : high) =
        0.5 * (low + high);
  return high;
}

NominalError error_of(const Eigen::Matrix3d& covariance, double heading_sigma) {
  NominalError error;
  error.position_covariance_n = covariance;
  error.heading_variance = heading_sigma * heading_sigma;
  return error;
}

Eigen::Matrix3d turned(const Eigen::Vector3d& sigmas, double angle) {
  const Eigen::Matrix3d C = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return C * sigmas.cwiseAbs2().asDiagonal() * C.transpose();
}

}  // namespace

TEST_CASE("the levels of a circle are quantiles of the normal distribution") {
  const NominalError error = error_of(Eigen::Vector3d(4.0, 4.0, 9.0).asDiagonal(), 0.02);
  const ProtectionLevels levels = protection_levels(error, {}, normal_errors(1e-6));
  CHECK(levels.horizontal_m == Approx(std::numbers::sqrt2 * 2.0 * quantile(0.5e-6)).epsilon(1e-8));
  CHECK(levels.vertical_m == Approx(3.0 * quantile(1e-6)).epsilon(1e-8));
  CHECK(levels.heading == Approx(0.02 * quantile(1e-6)).epsilon(1e-8));
}

TEST_CASE("the horizontal level depends on the axes of the ellipse, not on its direction") {
  const Eigen::Vector3d sigmas(3.0, 0.5, 2.0);
  const double expected = std::hypot(3.0, 0.5) * quantile(0.5e-6);
  for (const double angle : {0.0, 0.3, 1.5707963, 2.0, -1.0}) {
    const Eigen::Matrix3d covariance = turned(sigmas, angle);
    // The axes, found another way.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance.topLeftCorner<2, 2>());
    CHECK(std::sqrt(axes.eigenvalues().sum()) == Approx(std::hypot(3.0, 0.5)));
    const ProtectionLevels levels =
        protection_levels(error_of(covariance, 0.1), {}, normal_errors(1e-6));
    CHECK(levels.horizontal_m == Approx(expected).epsilon(1e-8));
  }
}

TEST_CASE("drawn errors exceed the levels no more often than the risk allows") {
  constexpr double kRisk = 0.02;
  constexpr int kDraws = 400'000;
  IntegrityConfig config = normal_errors(kRisk);
  config.overbound = {1.0, 0.1, 3.0};
  const Eigen::Matrix3d covariance = turned({2.0, 1.0, 1.5}, 0.7);
  FaultHypothesis fault;
  fault.probability = 0.05;
  fault.separation_n = {3.0, -4.0, 6.0};
  fault.separation_covariance_n = 0.5 * covariance;
  const ProtectionLevels levels = protection_levels(error_of(covariance, 0.1), {&fault, 1}, config);

  const Eigen::Matrix3d root = covariance.llt().matrixL();
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  int beyond_horizontal = 0, beyond_vertical = 0;
  for (int i = 0; i < kDraws; ++i) {
    const bool faulty = uniform(generator) < fault.probability;
    const double factor = uniform(generator) < config.overbound.tail_share ? 3.0 : 1.0;
    Eigen::Vector3d unit;
    for (int axis = 0; axis < 3; ++axis) unit[axis] = normal(generator);
    Eigen::Vector3d error = factor * (faulty ? std::sqrt(1.5) : 1.0) * (root * unit);
    if (faulty) error += fault.separation_n;
    beyond_horizontal += error.head<2>().norm() > levels.horizontal_m ? 1 : 0;
    beyond_vertical += std::abs(error.z()) > levels.vertical_m ? 1 : 0;
  }
  const double three_sigma = 3.0 * std::sqrt(kRisk / kDraws);
  CHECK(static_cast<double>(beyond_vertical) / kDraws <= kRisk + three_sigma);
  CHECK(static_cast<double>(beyond_vertical) / kDraws > 0.4 * kRisk);  // and not far below
  CHECK(static_cast<double>(beyond_horizontal) / kDraws <= kRisk + three_sigma);
  CHECK(static_cast<double>(beyond_horizontal) / kDraws > 0.05 * kRisk);
}

TEST_CASE("a likely fault adds its separation, one that nobody believes in adds nothing") {
  const NominalError error = error_of(Eigen::Matrix3d::Identity(), 0.01);
  FaultHypothesis fault;
  fault.probability = 1.0;
  fault.separation_n = {0.0, 0.0, -7.0};
  fault.separation_covariance_n(2, 2) = 3.0;
  fault.heading_separation = -0.2;
  fault.heading_separation_variance = 3e-4;
  const IntegrityConfig config = normal_errors(1e-6);
  const double set_aside = 0.01;  // for the growth until the next epoch
  const double K = quantile(1e-6 * (1.0 - set_aside));
  ProtectionLevels levels = protection_levels(error, {&fault, 1}, config);
  CHECK(levels.vertical_m == Approx(7.0 + 2.0 * K).epsilon(1e-8));
  CHECK(levels.heading == Approx(0.2 + 0.02 * K).epsilon(1e-8));
  fault.probability = 0.0;
  levels = protection_levels(error, {&fault, 1}, config);
  CHECK(levels.vertical_m == Approx(K).epsilon(1e-8));
}

TEST_CASE("a bias that does not average out adds itself") {
  NominalError error = error_of(Eigen::Matrix3d::Identity(), 0.01);
  const ProtectionLevels without = protection_levels(error, {}, normal_errors(1e-6));
  error.position_bias_n = {0.0, 0.0, -0.75};
  const ProtectionLevels with = protection_levels(error, {}, normal_errors(1e-6));
  CHECK(with.vertical_m - without.vertical_m == Approx(0.75).epsilon(1e-7));
  CHECK(with.horizontal_m == without.horizontal_m);
}

TEST_CASE("a heading that is not known has no level, and no level exceeds half a turn") {
  NominalError error;
  error.position_covariance_n.setIdentity();
  CHECK(std::isnan(protection_levels(error, {}, IntegrityConfig()).heading));
  CHECK(protection_levels(error, {}, IntegrityConfig()).horizontal_m > 5.0);
  error.heading_variance = 4.0;
  CHECK(protection_levels(error, {}, IntegrityConfig()).heading == std::numbers::pi);
  error.position_covariance_n(2, 2) = std::nan("");
  CHECK(std::isnan(protection_levels(error, {}, IntegrityConfig()).vertical_m));
}
