// What the size of the mean specific force says of its unit.
#include "core/conventions/force_check.h"

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

}  // namespace
