// North from the Earth's rotation while standing: as good as its sigma says, and never from a
// turntable.
#include <cmath>
#include <optional>
#include <random>

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/inertial/alignment/alignment.h"
#include "support/catch.h"
#include "synthetic_vehicle.h"

namespace leonav {
namespace {

using test::tactical_imu;

constexpr double kDt = 0.01;
const Geodetic kWhere{48.0 * kDegree, 11.0 * kDegree, 500.0};

struct Stand {
  double heading = 0.0;    // rad
  double turn_rate = 0.0;  // rad/s, of a table
  double seconds = 60.0;
};

struct Found {
  double after_s = 0.0, error = 0.0, sigma = 0.0;
};

// The first attitude while standing level; the gyros' bias drawn from `truth`.
std::optional<Found> align(const Stand& stand, const ImuErrorModel& truth,
                           const ImuErrorModel& told, std::mt19937_64* bits) {
  std::normal_distribution<double> normal;
  const auto three = [&] { return Eigen::Vector3d(normal(*bits), normal(*bits), normal(*bits)); };
  const Eigen::Vector3d bias_b = truth.gyro_bias.sigma * three();
  Alignment alignment(AlignmentConfig(), told);
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(kWhere);
  const Eigen::Vector3d earth_n = C_ne * Eigen::Vector3d(0.0, 0.0, kEarthRotationRate);
  double heading = stand.heading;
  for (int i = 1; i * kDt <= stand.seconds; ++i) {
    heading += stand.turn_rate * kDt;
    const Eigen::Matrix3d C_nb = rotation_from_euler({0.02, -0.03, heading});
    ImuSample sample;
    sample.interval_ns = 10'000'000;
    sample.time = GpsTime::from_week_and_tow(2400, 0.0).plus_nanoseconds(i * 10'000'000LL);
    sample.delta_theta_b =
        kDt * (C_nb.transpose() * (earth_n + Eigen::Vector3d(0.0, 0.0, stand.turn_rate)) + bias_b) +
        std::sqrt(kDt) * truth.angle_random_walk * three();
    sample.delta_velocity_b = kDt * (C_nb.transpose() * Eigen::Vector3d(0.0, 0.0, -9.81)) +
                              std::sqrt(kDt) * truth.velocity_random_walk * three();
    alignment.add(sample);
    if (i % 100 != 0) continue;
    const auto aligned =
        alignment.attitude(to_ecef(kWhere), Eigen::Vector3d(0.001, 0.002, -0.001), 0.02);
    if (!aligned) continue;
    const double yaw = euler_from_rotation(C_ne * aligned->q_eb.toRotationMatrix()).yaw;
    return Found{i * kDt, wrap_to_pi(yaw - heading), aligned->sigma_rpy.z()};
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("tactical gyros find north while standing, as well as they say") {
  std::mt19937_64 bits(5);
  constexpr int kRuns = 200;
  double squares = 0.0, latest = 0.0, worst = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const auto found = align({.heading = (-180.0 + 360.0 * run / kRuns) * kDegree}, tactical_imu(),
                             tactical_imu(), &bits);
    REQUIRE(found);
    squares += found->error * found->error / (found->sigma * found->sigma);
    latest = std::max(latest, found->after_s);
    worst = std::max(worst, std::abs(found->error) / found->sigma);
  }
  WARN("north found after " << latest << " s at the latest; errors over sigma: rms "
                            << std::sqrt(squares / kRuns) << ", worst " << worst);
  CHECK(latest <= 40.0);
  CHECK(squares / kRuns > 0.7);
  CHECK(squares / kRuns < 1.3);
  CHECK(worst < 4.0);
}

TEST_CASE("what turns with a table, or has gyros beyond their data sheet, finds no north") {
  std::mt19937_64 bits(6);
  ImuErrorModel bad = tactical_imu();
  bad.gyro_bias.sigma *= 60.0;
  int wrong = 0;
  for (int run = 0; run < 50; ++run) {
    CHECK_FALSE(align({.heading = 0.1 * run, .turn_rate = 0.01 * kDegree}, tactical_imu(),
                      tactical_imu(), &bits));
    const auto found = align({.heading = 0.1 * run}, bad, tactical_imu(), &bits);
    wrong += found && std::abs(found->error) > 5.0 * found->sigma ? 1 : 0;
  }
  // A bias of 30 deg/h looks like the Earth's 15 in length and inclination only by chance.
  CHECK(wrong <= 1);
  ImuErrorModel mems = tactical_imu();
  mems.gyro_bias.sigma = 1000.0 * kDegree / 3600.0;
  CHECK_FALSE(align({}, mems, mems, &bits));
}

}  // namespace leonav
