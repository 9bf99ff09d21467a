#include "core/inertial/strapdown/imu_gap_fill.h"

#include <cmath>

#include "support/catch.h"

namespace leonav {
namespace {

using Eigen::Vector3d;

GpsTime at_ms(int ms) {
  return GpsTime::from_week_and_tow(2300, 1000.0).plus_nanoseconds(ms * 1'000'000LL);
}

// Rate and force that change linearly: the mean over an interval is that at its middle.
Vector3d rate_at(double t) { return Vector3d{0.1, -0.2, 0.3} + t * Vector3d{2.0, -1.0, 0.5}; }
Vector3d force_at(double t) { return Vector3d{1.0, 0.5, -9.8} + t * Vector3d{-3.0, 4.0, 1.0}; }

ImuSample linear_sample(int from_ms, int to_ms) {
  ImuSample sample;
  sample.time = at_ms(to_ms);
  sample.interval_ns = (to_ms - from_ms) * 1'000'000LL;
  const double middle = 0.5e-3 * (from_ms + to_ms);
  sample.delta_theta_b = sample.interval_s() * rate_at(middle);
  sample.delta_velocity_b = sample.interval_s() * force_at(middle);
  return sample;
}

}  // namespace

TEST_CASE("A hole between linear rates is filled exactly, in one part or several", "[ins]") {
  const ImuSample previous = linear_sample(0, 5);
  const ImuSample next = linear_sample(25, 35);  // another rate: intervals differ
  for (const auto& [from, to] : {std::pair{5, 25}, {5, 12}, {12, 25}}) {
    CAPTURE(from, to);
    const auto gap_fill = fill_imu_gap(previous, at_ms(from), at_ms(to), next);
    REQUIRE(gap_fill);
    const ImuSample expected = linear_sample(from, to);
    CHECK(gap_fill->sample.time == expected.time);
    CHECK(gap_fill->sample.start() == expected.start());
    CHECK((gap_fill->sample.delta_theta_b - expected.delta_theta_b).norm() < 1e-12);
    CHECK((gap_fill->sample.delta_velocity_b - expected.delta_velocity_b).norm() < 1e-12);
  }
}

TEST_CASE("The stated sigma of a bridge covers a rate that stays as before or is as after",
          "[ins]") {
  const ImuSample previous = linear_sample(0, 5);
  ImuSample next = linear_sample(55, 60);
  next.delta_theta_b += Vector3d{0.01, 0.0, 0.0};  // 2 rad/s more
  const auto gap_fill = fill_imu_gap(previous, at_ms(5), at_ms(55), next);
  REQUIRE(gap_fill);
  for (const ImuSample& neighbour : {previous, next}) {
    const Vector3d held = 0.050 / 0.005 * neighbour.delta_theta_b;
    const Vector3d error = (held - gap_fill->sample.delta_theta_b).cwiseAbs();
    for (int i = 0; i < 3; ++i) CHECK(error(i) <= gap_fill->sigma_theta_b(i));
  }
  // One lost sample of a steady vehicle costs next to nothing: 0.1 rad/sqrt(s) would be 7e-3 rad.
  const auto steady = fill_imu_gap(previous, at_ms(5), at_ms(10), linear_sample(10, 15));
  REQUIRE(steady);
  CHECK(steady->sigma_theta_b.maxCoeff() < 1e-4);
  CHECK(steady->sigma_velocity_b.maxCoeff() < 1e-3);
}

TEST_CASE(
    "With one neighbour a hole takes its rates and is less sure; with none there is no bridge",
    "[ins]") {
  const ImuSample previous = linear_sample(0, 5), next = linear_sample(25, 30);
  const auto both = fill_imu_gap(previous, at_ms(5), at_ms(25), next);
  const auto held = fill_imu_gap(previous, at_ms(5), at_ms(25), ImuSample{});
  const auto taken = fill_imu_gap(ImuSample{}, at_ms(5), at_ms(25), next);
  REQUIRE((both && held && taken));
  CHECK((held->sample.delta_theta_b - 4.0 * previous.delta_theta_b).norm() < 1e-15);
  CHECK((taken->sample.delta_velocity_b - 4.0 * next.delta_velocity_b).norm() < 1e-15);
  CHECK(held->sigma_theta_b.x() >
        0.5 * std::abs(both->sample.delta_theta_b.x() - held->sample.delta_theta_b.x()));
  CHECK_FALSE(fill_imu_gap(ImuSample{}, at_ms(5), at_ms(25), ImuSample{}));
}

TEST_CASE("No bridge is longer than its limit, not even in parts", "[ins]") {
  const ImuSample previous = linear_sample(0, 5);
  CHECK(fill_imu_gap(previous, at_ms(5), at_ms(205), linear_sample(205, 210)));
  CHECK_FALSE(fill_imu_gap(previous, at_ms(5), at_ms(206), linear_sample(206, 210)));
  CHECK_FALSE(fill_imu_gap(previous, at_ms(150), at_ms(300), linear_sample(300, 305)));
  CHECK_FALSE(fill_imu_gap(previous, at_ms(5), at_ms(100), linear_sample(300, 305)));
  CHECK_FALSE(fill_imu_gap(previous, at_ms(150), at_ms(250), ImuSample{}));
  CHECK_FALSE(fill_imu_gap(previous, at_ms(5), at_ms(5), linear_sample(10, 15)));
  CHECK_FALSE(fill_imu_gap(previous, at_ms(10), at_ms(5), linear_sample(10, 15)));
  CHECK_FALSE(fill_imu_gap(previous, at_ms(0), at_ms(10), linear_sample(10, 15)));
}

}  // namespace leonav
