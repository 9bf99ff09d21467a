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

TEST_CASE("a solve of every preset with an IMU can be measured") {
  for (const std::string preset : {"car", "demo", "phone_imu", "urban", "walk"}) {
    const NavigatorConfig config = smoothing(preset, {});
    if (config.motion != MotionModel::kInertial) continue;
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
