// What a solve takes on this machine is measured before the service depends on it.
#include "daemon/engine/solve_time.h"

#include <string>
#include <vector>

#include "daemon/config/load_config.h"
#include "daemon/config/presets.h"
#include "support/catch.h"

namespace {

using namespace leonav;
using Catch::Matchers::Contains;

NavigatorConfig smoothing(const std::string& preset, const std::vector<std::string>& overrides) {
  std::vector<std::string> all = {"estimator=smoother"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return load_preset(preset, all).navigator;
}

}  // namespace

TEST_CASE("a solve of every preset can be measured, without an IMU too") {
  for (const std::string preset : {"car", "demo", "phone", "phone_imu", "urban", "walk"}) {
    const NavigatorConfig config = smoothing(preset, {});
    const SolveTime time = measure_solve_time(config);
    CAPTURE(preset, time.satellites, time.solve_s);
    CHECK(time.solved == kMeasuredSolves);
    CHECK(time.solve_s > 0.0);
    CHECK(time.solve_s < 1.0);
  }
}

TEST_CASE("the measured time grows with the window, the satellites with the systems") {
  const SolveTime few =
      measure_solve_time(smoothing("car", {"smoother.window=5", "gnss.systems=[gps]"}));
  const SolveTime longer =
      measure_solve_time(smoothing("car", {"smoother.window=40", "gnss.systems=[gps]"}));
  const SolveTime more = measure_solve_time(
      smoothing("car", {"smoother.window=5", "gnss.systems=[gps, galileo, beidou, leo]"}));
  CHECK(more.satellites > 2 * few.satellites);
  CHECK(longer.solve_s > 1.5 * few.solve_s);
}

TEST_CASE("a configuration that cannot keep its deadline here is refused, with the remedy") {
  const NavigatorConfig config = smoothing(
      "car",
      {"smoother.window=60", "realtime.deadline_smoother_ms=100", "realtime.deadline_ekf_ms=100"});
  SolveTime time;
  time.satellites = 30;
  time.solved = kMeasuredSolves;
  time.solve_s = 0.049;
  CHECK_NOTHROW(require_in_time(config, time));
  time.solve_s = 0.051;
  CHECK_THROWS_WITH(require_in_time(config, time),
                    Contains("60 keyframes with 30 satellites takes 51.0 ms") &&
                        Contains("realtime.deadline_smoother_ms (100)"));
}

TEST_CASE("the deadline that a solve is held against is the larger one, and both are named") {
  const NavigatorConfig config =
      smoothing("car", {"realtime.deadline_smoother_ms=100", "realtime.deadline_ekf_ms=200"});
  CHECK(config.realtime.smoother_deadline_s() == 0.2);
  SolveTime time;
  time.solve_s = 0.099;
  CHECK_NOTHROW(require_in_time(config, time));
  time.solve_s = 0.101;
  CHECK_THROWS_WITH(require_in_time(config, time),
                    Contains("deadline of 200 ms") &&
                        Contains("realtime.deadline_smoother_ms (100)") &&
                        Contains("realtime.deadline_ekf_ms (200)"));
}

TEST_CASE("without an IMU a solve is held against the time between keyframes") {
  const NavigatorConfig config =
      smoothing("phone", {"smoother.keyframe_interval_s=0", "realtime.epoch_interval_s=0.1",
                          "smoother.max_iterations=4"});
  REQUIRE(config.motion != MotionModel::kInertial);
  SolveTime time;
  time.solve_s = 0.012;
  CHECK_NOTHROW(require_in_time(config, time));
  time.solve_s = 0.013;
  CHECK_THROWS_WITH(require_in_time(config, time),
                    Contains("smoother.max_iterations (4)") && Contains("100 ms between") &&
                        Contains("realtime.epoch_interval_s (0.1)") &&
                        Contains("smoother.keyframe_interval_s (0)"));
}
