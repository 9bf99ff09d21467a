// Standing told from moving: noise, shaking, slow starts, turntables, and steady creeping, which an
// IMU alone cannot tell.
#include "core/vehicle/standstill_detector.h"

#include <cmath>
#include <numbers>
#include <random>

#include "support/catch.h"

namespace leonav {
namespace {

const Eigen::Vector3d kBias_b{0.003, -0.002, 0.001};

struct Feeling {
  double force_noise = 0.0;   // m/s^2, 1 sigma of a sample
  double shake = 0.0;         // m/s^2, amplitude at 25 Hz: an engine
  double acceleration = 0.0;  // m/s^2, forward, from half of the time on
  double yaw_rate = 0.0;      // rad/s
};

// Share of the instants, ten a second, at which it feels still; the first two seconds do not count.
double share_still(const Feeling& feeling, double seconds) {
  StandstillDetector detector{StandstillConfig()};
  std::mt19937_64 bits(3);
  std::normal_distribution<double> normal;
  constexpr double kDt = 0.005;
  int still = 0, asked = 0;
  const int samples = static_cast<int>(std::lround(seconds / kDt));
  for (int i = 1; i <= samples; ++i) {
    const double t = i * kDt;
    ImuSample sample;
    sample.time = GpsTime::from_week_and_tow(2400, 100.0).plus_nanoseconds(i * 5'000'000LL);
    sample.interval_ns = 5'000'000;
    Eigen::Vector3d force_b{0.3, 0.1, -9.8};
    force_b.x() += feeling.shake * std::sin(2.0 * std::numbers::pi * 25.0 * t);
    if (t > 0.5 * seconds) force_b.x() += feeling.acceleration;
    force_b += feeling.force_noise * Eigen::Vector3d(normal(bits), normal(bits), normal(bits));
    sample.delta_velocity_b = kDt * force_b;
    sample.delta_theta_b = kDt * (kBias_b + Eigen::Vector3d{0.0, 0.0, feeling.yaw_rate});
    detector.add(sample);
    if (i % 20 != 0 || t < 2.2) continue;
    ++asked;
    still += detector.imu_is_static(kBias_b) ? 1 : 0;
  }
  return static_cast<double>(still) / asked;
}

}  // namespace

TEST_CASE("a standing IMU feels still through its noise and an engine's shaking") {
  CHECK(share_still({.force_noise = 0.05}, 60.0) > 0.99);
  CHECK(share_still({.force_noise = 0.05, .shake = 0.3}, 60.0) > 0.99);
}

TEST_CASE("what sets off or turns does not feel still") {
  // Half of the time it stands; the second in which it sets off does not count as still.
  const double share = share_still({.force_noise = 0.02, .acceleration = 0.5}, 20.0);
  CHECK(share < 0.96);
  CHECK(share_still({.force_noise = 0.02, .yaw_rate = 0.02}, 20.0) == 0.0);
}

TEST_CASE("a gentle start is felt within a second, by the mean alone") {
  StandstillDetector detector{StandstillConfig()};
  std::mt19937_64 bits(5);
  std::normal_distribution<double> normal;
  for (int i = 1; i <= 1400; ++i) {  // seven seconds, from the fifth on 0.05 m/s^2
    ImuSample sample;
    sample.time = GpsTime::from_week_and_tow(2400, 100.0).plus_nanoseconds(i * 5'000'000LL);
    sample.interval_ns = 5'000'000;
    const Eigen::Vector3d noise(normal(bits), normal(bits), normal(bits));
    const double push = i > 1000 ? 0.05 : 0.0;
    const double shake = 0.3 * std::sin(2.0 * std::numbers::pi * 25.0 * 0.005 * i);
    sample.delta_velocity_b =
        0.005 * (Eigen::Vector3d{0.2 + push + shake, 0.1, -9.8} + 0.02 * noise);
    sample.delta_theta_b = 0.005 * kBias_b;
    detector.add(sample);
    if (i == 1000) CHECK(detector.imu_is_static(kBias_b));
    if (i > 1160 && i <= 1300) CHECK_FALSE(detector.imu_is_static(kBias_b));
  }
}

TEST_CASE("creeping feels like standing: the speed decides") {
  StandstillDetector detector{StandstillConfig()};
  for (int i = 1; i <= 440; ++i) {
    ImuSample sample;
    sample.time = GpsTime::from_week_and_tow(2400, 100.0).plus_nanoseconds(i * 5'000'000LL);
    sample.interval_ns = 5'000'000;
    sample.delta_velocity_b = Eigen::Vector3d{0.0, 0.0, -0.049};
    sample.delta_theta_b = 0.005 * kBias_b;
    detector.add(sample);
  }
  REQUIRE(detector.imu_is_static(kBias_b));
  CHECK(detector.stands(kBias_b, 0.0, 0.02));
  CHECK_FALSE(detector.stands(kBias_b, 0.1, 0.001));
  // Known too badly to tell.
  CHECK_FALSE(detector.stands(kBias_b, 0.0, 0.03));
  CHECK((detector.rate_b() - kBias_b).norm() < 1e-12);
}

TEST_CASE("a hole in the data ends what was felt before it") {
  StandstillDetector detector{StandstillConfig()};
  for (int i = 1; i <= 460; ++i) {
    ImuSample sample;
    const std::int64_t hole = i > 450 ? 2'000'000'000LL : 0;
    sample.time = GpsTime::from_week_and_tow(2400, 100.0).plus_nanoseconds(i * 5'000'000LL + hole);
    sample.interval_ns = 5'000'000;
    sample.delta_velocity_b = Eigen::Vector3d{0.0, 0.0, -0.049};
    sample.delta_theta_b = 0.005 * kBias_b;
    if (i == 450) REQUIRE(detector.imu_is_static(kBias_b));
    detector.add(sample);
  }
  CHECK_FALSE(detector.imu_is_static(kBias_b));
}

}  // namespace leonav
