// What HEALTH says of work that is late or fails, on purpose or not.
#include "daemon/health/internal/load_monitor.h"

#include "discard.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"

TEST_CASE("what a drill asks for is told as a drill, and nothing else is") {
  using namespace leonav;
  const bool delays = GENERATE(false, true), fails = GENERATE(false, true);
  CAPTURE(delays, fails);
  DaemonConfig config = test::drive_config();
  config.drill.late_solve_every = delays ? 3 : 0;
  config.navigator.smoother.drill_failure_every = fails ? 3 : 0;
  test::Discard target;
  Engine engine(config, &target);
  LoadMonitor monitor(&engine);
  CHECK(monitor.look().empty());
  engine.counters().misses.add(1);
  engine.counters().smoother_misses.add(1);
  engine.counters().smoother_failures.add(1);
  const auto found = monitor.look();
  REQUIRE(found.size() == 3);
  CHECK(found[0].reason == HealthReason::kDeadlineMissed);
  CHECK(found[0].detail.empty());
  CHECK(found[1].reason == HealthReason::kSmootherLate);
  CHECK(found[1].detail == (delays ? "drill" : ""));
  CHECK(found[2].reason == HealthReason::kSmootherFailed);
  CHECK(found[2].detail == (fails ? "drill" : ""));
  CHECK(monitor.look().empty());
}
