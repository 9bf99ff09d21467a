// Constraints that the filter leaves out, counted by hand.
#include "core/vehicle/constraint_monitor.h"

#include "support/catch.h"

namespace leonav::test {
namespace {

constexpr double kInterval_s = 0.5;
constexpr int kSide = static_cast<int>(MotionComponent::kSide);
constexpr int kVertical = static_cast<int>(MotionComponent::kVertical);

// Instants with both constraints of a wheeled vehicle; the filter has left out `left_out`.
void add(int instants, MotionComponents left_out, ConstraintMonitor* monitor) {
  MotionMeasurements measurements(2);
  measurements[0].component = kSide;
  measurements[1].component = kVertical;
  const unsigned both = 1u << kSide | 1u << kVertical;
  for (int i = 0; i < instants; ++i)
    monitor->add(measurements, static_cast<MotionComponents>(both & ~left_out));
}

}  // namespace

TEST_CASE("constraints that are left out for seconds are a contradiction, reported once") {
  ConstraintMonitor monitor(kInterval_s);
  add(10, 1u << kVertical, &monitor);
  CHECK_FALSE(monitor.contradiction());  // too few instants
  add(10, 1u << kVertical, &monitor);
  const auto found = monitor.contradiction();
  REQUIRE(found);
  CHECK(found->share == Approx(1.0));
  CHECK(found->left_out == 1u << kVertical);
  add(10, 1u << kVertical, &monitor);
  CHECK_FALSE(monitor.contradiction());
  // It has to be over before it may begin again.
  add(40, 0, &monitor);
  CHECK_FALSE(monitor.contradiction());
  add(40, 1u << kSide, &monitor);
  CHECK(monitor.contradiction()->left_out == 1u << kSide);
}

TEST_CASE("constraints that are left out now and then, or before a reset, are no contradiction") {
  ConstraintMonitor monitor(kInterval_s);
  for (int i = 0; i < 30; ++i) {
    add(2, 0, &monitor);
    add(1, 1u << kSide, &monitor);
    CHECK_FALSE(monitor.contradiction());
  }
  add(100, 1u << kSide, &monitor);
  monitor.reset();
  CHECK_FALSE(monitor.contradiction());
}

}  // namespace leonav::test
