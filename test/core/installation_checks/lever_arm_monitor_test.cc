// The antenna's swing in turns tells where it is.
#include "core/installation_checks/internal/lever_arm_monitor.h"

#include "level_drive.h"
#include "support/catch.h"

namespace {

using namespace leonav;

LeverArmMonitor after(const Eigen::Vector3d& told_b, const Eigen::Vector3d& true_b, int seconds) {
  LeverArmMonitor check(told_b);
  test::LevelDrive drive(true_b);
  for (int i = 0; i < seconds; ++i) {
    test::feed_second(&drive, &check, test::nothing);
    const PointSolution point = drive.point();
    const Eigen::Quaterniond q_eb = drive.q_eb();
    check.end_second(drive.time(), &point, &q_eb);
  }
  return check;
}

const Eigen::Vector3d kArm(1.5, 0.4, -1.2);

TEST_CASE("the arm that is told is the arm: no word", "[conventions]") {
  const LeverArmMonitor check = after(kArm, kArm, 60);
  CHECK(check.is_known());
  CHECK(!check.evaluate());
}

TEST_CASE("an arm of the wrong sign", "[conventions]") {
  CHECK(after(-kArm, kArm, 60).evaluate().convention == Convention::kLeverArmSign);
  const Eigen::Vector3d forward_only(-kArm.x(), kArm.y(), kArm.z());
  const auto finding = after(forward_only, kArm, 60).evaluate();
  CHECK(finding.convention == Convention::kLeverArmSign);
  CHECK(finding.value == Approx(3.0).margin(0.5));
}

TEST_CASE("another arm", "[conventions]") {
  CHECK(after(Eigen::Vector3d::Zero(), kArm, 60).evaluate().convention == Convention::kLeverArm);
}

TEST_CASE("straight on nothing is known of the arm", "[conventions]") {
  const LeverArmMonitor check = after(-kArm, kArm, 18);
  CHECK(!check.is_known());
  CHECK(!check.evaluate());
}

TEST_CASE("without an attitude nothing is known of the arm", "[conventions]") {
  LeverArmMonitor check(-kArm);
  test::LevelDrive drive(kArm);
  for (int i = 0; i < 60; ++i) {
    test::feed_second(&drive, &check, test::nothing);
    const PointSolution point = drive.point();
    check.end_second(drive.time(), &point, nullptr);
  }
  CHECK(!check.evaluate());
}

}  // namespace
