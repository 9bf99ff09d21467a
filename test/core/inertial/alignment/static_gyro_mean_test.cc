// Is what a standstill tells of the gyros' bias as good as it says?
#include "core/inertial/alignment/internal/static_gyro_mean.h"

#include <cmath>
#include <random>

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"
#include "support/catch.h"

namespace leonav {
namespace {

constexpr double kHour = 3600.0;

ImuErrorModel degree_per_hour_imu() {
  ImuErrorModel imu;
  imu.angle_random_walk = 0.05 * kDegree / std::sqrt(kHour);
  imu.gyro_bias.sigma = 1.0 * kDegree / kHour;
  return imu;
}

}  // namespace

TEST_CASE("the bias of a standstill errs as much as it states, also where white noise is all") {
  const ImuErrorModel imu = degree_per_hour_imu();
  std::mt19937_64 bits(7);
  std::normal_distribution<double> normal;
  for (const int windows : {3, 10, 60}) {
    double squares = 0.0;
    constexpr int kRuns = 2000;
    for (int run = 0; run < kRuns; ++run) {
      const Eigen::Vector3d bias =
          imu.gyro_bias.sigma * Eigen::Vector3d(normal(bits), normal(bits), normal(bits));
      StaticGyroMean standing(imu);
      for (int i = 0; i < windows; ++i)
        standing.add(bias + imu.angle_random_walk *
                                Eigen::Vector3d(normal(bits), normal(bits), normal(bits)),
                     1.0);
      REQUIRE(standing.known());
      squares +=
          (standing.rate_b() - bias).squaredNorm() / (3.0 * standing.sigma() * standing.sigma());
    }
    CAPTURE(windows, squares / kRuns);
    // Of 6000 squares: three standard deviations; conservative where few windows scatter by chance.
    CHECK(squares / kRuns < 1.06);
    CHECK(squares / kRuns > 0.9);
  }
}

TEST_CASE("a turn among the windows is refused, or widens what is stated") {
  ImuErrorModel imu = degree_per_hour_imu();
  StaticGyroMean standing(imu);
  const Eigen::Vector3d turn(0.0, 0.0, -0.58 * kDegree);
  CHECK_FALSE(standing.is_plausible(turn, 1.0));
  CHECK(standing.is_plausible(Eigen::Vector3d(0.0, 0.0, kEarthRotationRate), 1.0));
  CHECK(standing.rate_b().isZero(0.0));
  CHECK(standing.sigma() == Approx(imu.gyro_bias.sigma));

  imu.gyro_bias.sigma = 1000.0 * kDegree / kHour;  // consumer grade: the turn could be its bias
  StaticGyroMean loose(imu);
  REQUIRE(loose.is_plausible(turn, 1.0));
  for (int i = 0; i < 25; ++i) loose.add(Eigen::Vector3d::Zero(), 1.0);
  const double before = loose.sigma();
  loose.add(turn, 1.0);
  CHECK(loose.rate_b().norm() < 3.0 * loose.sigma());
  CHECK(loose.sigma() > 10.0 * before);
  loose.clear();
  CHECK_FALSE(loose.known());
}

}  // namespace leonav
