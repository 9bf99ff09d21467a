// What mistake makes samples that no IMU can have measured.
#include "core/installation_checks/refused_imu_monitor.h"

#include "support/catch.h"

namespace {

using namespace leonav;

ImuSample sample_of(double angle, double velocity) {
  ImuSample sample;
  sample.time = GpsTime::from_nanoseconds(1'300'000'000'000'000'000);
  sample.interval_ns = 5'000'000;
  sample.delta_theta_b = Eigen::Vector3d(0.0, 0.0, angle);
  sample.delta_velocity_b = Eigen::Vector3d(0.0, 0.0, -velocity);
  return sample;
}

ConventionFinding found(const ImuSample& sample, int refused, int accepted_between = 0) {
  RefusedImuMonitor watch;
  ConventionFinding first;
  for (int i = 0; i < refused; ++i) {
    const auto finding = watch.add_refused(sample);
    if (finding && !first) first = finding;
    for (int k = 0; k < accepted_between; ++k) watch.add_accepted();
  }
  return first;
}

TEST_CASE("rates handed in as increments", "[conventions]") {
  const auto finding = found(sample_of(0.01, 9.8), 200);
  CHECK(finding.convention == Convention::kRatesAsIncrements);
  CHECK(finding.value == Approx(200.0).epsilon(0.01));
}

TEST_CASE("samples that are refused for minutes are found again each minute", "[conventions]") {
  RefusedImuMonitor watch;
  int found = 0;
  for (int i = 0; i < 200 * 130; ++i) {
    if (watch.add_refused(sample_of(0.5, 0.049))) ++found;
  }
  CHECK(found == 3);
}

TEST_CASE("gyros out of range while gravity is right", "[conventions]") {
  CHECK(found(sample_of(0.5, 0.049), 200).convention == Convention::kGyroRange);
}

TEST_CASE("forces of another unit, out of range", "[conventions]") {
  CHECK(found(sample_of(0.0, 49.0), 200).convention == Convention::kForceUnit);
}

TEST_CASE("a burst of bad samples among good ones is no convention", "[conventions]") {
  CHECK(!found(sample_of(0.01, 9.8), 99));
  CHECK(!found(sample_of(0.01, 9.8), 1000, 2));
}

TEST_CASE("samples that are not numbers pass by", "[conventions]") {
  CHECK(!found(sample_of(std::nan(""), 1.0), 1000));
}

}  // namespace
