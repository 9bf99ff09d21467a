// Gyros against the course: unit, sign, axis, stamps.
#include "core/installation_checks/internal/yaw_rate_fit.h"

#include "level_drive.h"
#include "support/catch.h"

namespace {

using namespace leonav;
using test::kDown;

template <typename Change>
MotionRecord record_of(Change change, int seconds = 100) {
  MotionRecord record;
  test::LevelDrive drive;
  for (int i = 0; i < seconds; ++i) {
    test::feed_second(&drive, &record, change);
    const PointSolution point = drive.point();
    record.end_second(drive.time(), &point);
  }
  return record;
}

TEST_CASE("right gyros turn as the course does", "[conventions]") {
  const MotionRecord record = record_of(test::nothing);
  const YawRateFit fit = fit_yaw_rate(record, kDown);
  CHECK(fit.follows());
  CHECK(fit.slope == Approx(1.0).margin(0.03));
  CHECK(!check_yaw_rate_scale(fit, 0.01));
  CHECK(!check_yaw_rate_axis(record, fit));
  CHECK(!check_yaw_rate_delay(record, mean_force(record)));
}

TEST_CASE("before the first turn nothing is known", "[conventions]") {
  const YawRateFit fit = fit_yaw_rate(record_of(test::nothing, 20), kDown);
  CHECK(!fit.follows());
  CHECK(!fit.contradicts());
  CHECK(!check_yaw_rate_scale(fit, 0.01));
}

TEST_CASE("who walks turns too, in a vehicle that is no course", "[conventions]") {
  for (const CourseLimits limits : {kOnFoot, kInVehicle}) {
    MotionRecord record(limits);
    test::LevelDrive drive;
    for (int i = 0; i < 100; ++i) {
      test::feed_second(&drive, &record, test::nothing);
      PointSolution point = drive.point();
      point.v_e *= 0.15;  // 1.4 m/s at most
      record.end_second(drive.time(), &point);
    }
    const YawRateFit fit = fit_yaw_rate(record, kDown);
    const bool on_foot = limits.min_speed_m_s < 1.0;
    CHECK(fit.follows() == on_foot);
    CHECK((fit.seconds > 0) == on_foot);
    if (on_foot) CHECK(fit.slope == Approx(1.0).margin(0.05));
  }
}

TEST_CASE("gyros of another unit are told by their slope", "[conventions]") {
  const auto scaled = [](double factor) {
    const MotionRecord record =
        record_of([factor](ImuSample* sample) { sample->delta_theta_b *= factor; });
    return check_yaw_rate_scale(fit_yaw_rate(record, kDown), 0.01);
  };
  CHECK(scaled(180.0 / EIGEN_PI).convention == Convention::kGyrosInDegrees);
  CHECK(scaled(180.0 / EIGEN_PI).value == Approx(57.3).margin(2.0));
  CHECK(scaled(-180.0 / EIGEN_PI).convention == Convention::kGyrosInDegrees);
  CHECK(scaled(0.01).convention == Convention::kIncrementsTimesInterval);
  CHECK(scaled(EIGEN_PI / 180.0).convention == Convention::kGyroUnit);
  CHECK(!scaled(-1.0));
}

TEST_CASE("a second with a wrong course does not make a wrong unit", "[conventions]") {
  MotionRecord record;
  test::LevelDrive drive;
  for (int i = 0; i < 100; ++i) {
    test::feed_second(&drive, &record, test::nothing);
    PointSolution point = drive.point();
    if (i == 64) point.v_e = Eigen::AngleAxisd(2.0, drive.point().p_e.normalized()) * point.v_e;
    record.end_second(drive.time(), &point);
  }
  YawRateFit fit = fit_yaw_rate(record, kDown);
  CHECK(std::abs(fit.slope) < 0.7);
  CHECK(fit.median_ratio == Approx(1.0).margin(0.1));
  fit.correlation = 0.9;  // as where that second turns as much, the other way round
  CHECK(!check_yaw_rate_scale(fit, 0.01));
  fit.median_ratio = fit.slope;
  CHECK(check_yaw_rate_scale(fit, 0.01).convention == Convention::kGyroUnit);
}

TEST_CASE("a turn of the wrong sign has the opposite slope", "[conventions]") {
  const MotionRecord record = record_of([](ImuSample* sample) { sample->delta_theta_b *= -1.0; });
  CHECK(fit_yaw_rate(record, kDown).slope == Approx(-1.0).margin(0.03));
}

TEST_CASE("gyros in another order than the accelerometers", "[conventions]") {
  const MotionRecord record = record_of(
      [](ImuSample* sample) { std::swap(sample->delta_theta_b.x(), sample->delta_theta_b.z()); });
  const auto finding = check_yaw_rate_axis(record, fit_yaw_rate(record, kDown));
  CHECK(finding.convention == Convention::kGyroAxes);
  CHECK(finding.value == 1.0);
}

TEST_CASE("an IMU whose stamps are 18 s early turns 18 s before the course", "[conventions]") {
  MotionRecord record;
  test::LevelDrive drive, ahead;
  for (int i = 0; i < 1800; ++i) ahead.next();
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 100; ++k) {
      ImuSample sample = ahead.next();
      sample.time = sample.time.plus_seconds(-18.0);
      record.add(sample);
      drive.next();
    }
    const PointSolution point = drive.point();
    record.end_second(drive.time(), &point);
  }
  const auto finding = check_yaw_rate_delay(record, mean_force(record));
  CHECK(finding.convention == Convention::kLeapSeconds);
  CHECK(finding.value == -18.0);
}

TEST_CASE("samples and velocities with holes leave seconds out", "[conventions]") {
  MotionRecord record;
  test::LevelDrive drive;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 100; ++k) {
      const ImuSample sample = drive.next();
      if (i % 3 != 0 || k < 50) record.add(sample);
    }
    const PointSolution point = drive.point();
    record.end_second(drive.time(), i % 5 == 0 ? nullptr : &point);
  }
  int with_imu = 0;
  for (const MotionSecond& second : record.seconds()) {
    with_imu += second.has_imu ? 1 : 0;
    CHECK(second.seconds == Approx(1.0));
  }
  CHECK(record.seconds().size() == 59);
  CHECK(with_imu == 40);
}

}  // namespace
