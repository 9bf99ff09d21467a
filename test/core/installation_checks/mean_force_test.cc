// What the size of the mean specific force says of its unit.
#include "core/installation_checks/internal/mean_force.h"

#include <utility>

#include "level_drive.h"
#include "support/catch.h"

namespace {

using namespace leonav;

MeanForce of_ratio(double ratio) { return {30, ratio, Eigen::Vector3d(0.0, 0.0, -ratio)}; }

TEST_CASE("the unit of the specific force by its size", "[conventions]") {
  CHECK(!check_force_size(of_ratio(1.0), 0.005));
  CHECK(!check_force_size(of_ratio(1.2), 0.005));
  CHECK(check_force_size(of_ratio(0.102), 0.005).convention == Convention::kForceInG);
  CHECK(check_force_size(of_ratio(0.005), 0.005).convention ==
        Convention::kIncrementsTimesInterval);
  CHECK(check_force_size(of_ratio(0.01), 0.01).convention == Convention::kIncrementsTimesInterval);
  CHECK(check_force_size(of_ratio(0.05), 0.005).convention == Convention::kGravityMissing);
  CHECK(check_force_size(of_ratio(9.8), 0.005).convention == Convention::kForceUnit);
}

TEST_CASE("a few seconds say nothing of the unit", "[conventions]") {
  MeanForce force = of_ratio(0.102);
  force.seconds = 9;
  CHECK(!check_force_size(force, 0.005));
}

TEST_CASE("what lay on its side shows only in the seconds without a course", "[conventions]") {
  MotionRecord record;
  test::LevelDrive drive;
  PointSolution point;
  for (int i = 0; i < 100; ++i) {
    const bool lies = i < 60;
    test::feed_second(&drive, &record, [lies](ImuSample* sample) {
      if (lies) std::swap(sample->delta_velocity_b.y(), sample->delta_velocity_b.z());
    });
    point = drive.point();
    record.end_second(drive.time(), lies ? nullptr : &point);
  }
  CHECK(mean_force(record).tilt() > 0.8);
  const MeanForce moving = mean_force(record, MotionSeconds::kWithCourse);
  CHECK(moving.seconds > 20);
  CHECK(moving.seconds < 40);
  CHECK(moving.tilt() < 0.1);
}

}  // namespace
