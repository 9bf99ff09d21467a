// Which axis is forward, by braking and bends.
#include "core/installation_checks/internal/horizontal_axes_fit.h"
#include "core/base/angle.h"

#include "level_drive.h"
#include "support/catch.h"

namespace {

using namespace leonav;
using test::kDown;

// The forces' axes as rows of `axes`.
MotionRecord seen_by(const Eigen::Matrix3d& axes, int seconds = 100) {
  MotionRecord record;
  test::LevelDrive drive;
  for (int i = 0; i < seconds; ++i) {
    test::feed_second(&drive, &record, [&](ImuSample* sample) {
      sample->delta_velocity_b = axes * sample->delta_velocity_b;
    });
    const PointSolution point = drive.point();
    record.end_second(drive.time(), &point);
  }
  return record;
}

Eigen::Matrix3d rows(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
  Eigen::Matrix3d matrix;
  matrix << x.transpose(), y.transpose(), z.transpose();
  return matrix;
}

const Eigen::Vector3d kForward = Eigen::Vector3d::UnitX(), kRight = Eigen::Vector3d::UnitY();

ConventionFinding upright(const Eigen::Matrix3d& axes) {
  return check_horizontal_axes_upright(fit_horizontal_axes(seen_by(axes), 3.0));
}

ConventionFinding upside_down(const Eigen::Matrix3d& axes) {
  const MotionRecord record = seen_by(axes);
  return check_horizontal_axes_upside_down(fit_horizontal_axes(record, 3.0), mean_force(record));
}

TEST_CASE("forward, right, down is right", "[conventions]") {
  const HorizontalAxesFit fit = fit_horizontal_axes(seen_by(rows(kForward, kRight, kDown)), 3.0);
  CHECK(fit.is_right());
  CHECK(fit.turn_size == Approx(1.0).margin(0.05));
  CHECK(!check_horizontal_axes_upright(fit));
}

TEST_CASE("a sloping or crooked mounting of some degrees is right", "[conventions]") {
  CHECK(!upright(rotation_from_euler({0.1, -0.1, 0.3})));
}

TEST_CASE("without a bend nothing is known of right and left", "[conventions]") {
  CHECK(!fit_horizontal_axes(seen_by(rows(kForward, kRight, kDown), 20), 3.0).known);
}

TEST_CASE("horizontal axes that are others are named", "[conventions]") {
  CHECK(upright(rows(-kForward, -kRight, kDown)).convention == Convention::kBackwards);
  CHECK(upright(rows(kRight, kForward, kDown)).convention == Convention::kForwardRightExchanged);
  CHECK(upright(rows(kForward, -kRight, kDown)).convention == Convention::kMirrored);
  CHECK(upright(rows(-kForward, kRight, kDown)).convention == Convention::kMirrored);
}

TEST_CASE("an IMU turned about the vertical tells its mounting", "[conventions]") {
  for (const double yaw_deg : {90.0, -90.0, 60.0}) {
    // The mounting turns the IMU's axes into the body's, so the IMU sees the inverse.
    const Eigen::Matrix3d C_bi = rotation_from_euler({0.0, 0.0, yaw_deg * kDegree});
    const auto finding = upright(C_bi.transpose());
    CHECK(finding.convention == Convention::kTurned);
    CHECK(finding.value == Approx(yaw_deg).margin(3.0));
  }
}

TEST_CASE("third axis up: what the first two are", "[conventions]") {
  CHECK(upside_down(rows(kForward, -kRight, -kDown)).convention == Convention::kForwardLeftUp);
  CHECK(upside_down(rows(kRight, kForward, -kDown)).convention == Convention::kRightForwardUp);
  CHECK(upside_down(rows(-kForward, kRight, -kDown)).convention == Convention::kThirdAxisUp);
  CHECK(upside_down(rows(kForward, -kRight, -kDown)).value == Approx(180.0).margin(2.0));
}

TEST_CASE("a multicopter feels thrust along its own axis only: no word", "[conventions]") {
  Eigen::Matrix3d thrust = Eigen::Matrix3d::Zero();
  thrust(2, 2) = 1.0;
  CHECK(!upright(thrust));
}

}  // namespace
