// The six presets of ResetPlan, against a table written down by hand.
#include "core/navigator/stages/internal/reset_plan.h"

#include "support/catch.h"

namespace leonav {
namespace {

TEST_CASE("the six resets clear what their presets list, and nothing else") {
  struct Row {
    ResetPlan plan;
    FilterReset filter;
    CarrierReset carriers;
    bool alignment, external_heading, motion_aiding, outage, installation, times;
  };
  const auto kReset = FilterReset::kReset;
  const auto kRestart = FilterReset::kRestart;
  const auto kPosition = CarrierReset::kPosition;
  const Row rows[] = {
      {kCommandReset, kReset, CarrierReset::kAll, true, false, true, true, true, true},
      {kDropReset, kReset, kPosition, true, false, false, true, false, false},
      {kHeadingReset, kRestart, kPosition, true, true, false, false, false, false},
      {kWindowReset, FilterReset::kReplaced, kPosition, true, false, false, false, false, false},
      {kAttitudeReset, FilterReset::kForgetAttitude, kPosition, true, true, false, false, false,
       false},
      {restart_reset(true, true), kRestart, kPosition, false, false, false, false, false, false},
      {restart_reset(false, false), kRestart, kPosition, true, false, false, false, false, false},
  };
  for (const Row& row : rows) {
    CHECK(row.plan.filter == row.filter);
    CHECK(row.plan.carriers == row.carriers);
    CHECK(row.plan.clears_alignment == row.alignment);
    CHECK(row.plan.clears_external_heading == row.external_heading);
    CHECK(row.plan.clears_motion_aiding == row.motion_aiding);
    CHECK(row.plan.clears_outage_monitor == row.outage);
    CHECK(row.plan.clears_installation_monitor == row.installation);
    CHECK(row.plan.clears_times == row.times);
  }
  CHECK(kWindowReset.keeps_attitude);
  CHECK_FALSE(kAttitudeReset.keeps_attitude);
  CHECK(kAttitudeReset.keeps_vehicle_constants);
  CHECK(restart_reset(true, true).keeps_attitude);
  CHECK_FALSE(restart_reset(false, true).keeps_attitude);
  CHECK(restart_reset(false, true).keeps_vehicle_constants);
}

}  // namespace
}  // namespace leonav
