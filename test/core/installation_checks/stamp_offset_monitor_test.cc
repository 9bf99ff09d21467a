// IMU and GNSS stamped by different times, as they come in.
#include "core/installation_checks/stamp_offset_monitor.h"

#include "support/catch.h"

namespace {

using namespace leonav;

const GpsTime kStart = GpsTime::from_nanoseconds(1'300'000'000'000'000'000);

// An epoch a second and the IMU's samples between; the IMU's stamps are off by `offset_s`.
ConventionFinding found_in_stamps(double offset_s, int epochs, bool imu_goes_on = true) {
  StampOffsetMonitor watch;
  ConventionFinding first;
  for (int i = 0; i < epochs; ++i) {
    for (int k = 0; k < 100 && (imu_goes_on || i < 2); ++k)
      watch.add_imu(kStart.plus_seconds(i + 0.01 * k + offset_s));
    const auto finding = watch.add_epoch(kStart.plus_seconds(i + 0.9));
    if (finding && !first) first = finding;
  }
  return first;
}

TEST_CASE("stamps that agree but for latencies", "[conventions]") {
  for (const double offset_s : {0.0, 2.0, -2.0, 4.5}) CHECK(!found_in_stamps(offset_s, 60));
}

TEST_CASE("the leap seconds are called so", "[conventions]") {
  CHECK(found_in_stamps(-18.0, 20).convention == Convention::kLeapSeconds);
  CHECK(found_in_stamps(-18.0, 20).value == Approx(-18.0).margin(0.2));
  CHECK(found_in_stamps(18.0, 20).convention == Convention::kLeapSeconds);
  CHECK(found_in_stamps(604800.0, 20).convention == Convention::kStampOffset);
}

TEST_CASE("an offset that stays is found again each minute", "[conventions]") {
  StampOffsetMonitor watch;
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    for (int k = 0; k < 100; ++k) watch.add_imu(kStart.plus_seconds(i + 0.01 * k - 18.0));
    if (watch.add_epoch(kStart.plus_seconds(i + 0.9))) ++found;
  }
  CHECK(found == 4);  // after 8, 68, 128 and 188 s
}

TEST_CASE("a few epochs, or an IMU that has stopped, say nothing of stamps", "[conventions]") {
  CHECK(!found_in_stamps(-18.0, 6));
  CHECK(!found_in_stamps(0.0, 60, false));
}

TEST_CASE("an offset that wanders is of no clock", "[conventions]") {
  StampOffsetMonitor watch;
  for (int i = 0; i < 60; ++i) {
    watch.add_imu(kStart.plus_seconds(i - 10.0 - 3.0 * (i % 4)));
    CHECK(!watch.add_epoch(kStart.plus_seconds(i)));
  }
}

}  // namespace
