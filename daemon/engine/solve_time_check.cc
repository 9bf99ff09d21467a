#include "daemon/engine/solve_time_check.h"

#include <spdlog/spdlog.h>

#include "daemon/engine/solve_time.h"
#include "daemon/threads/realtime_thread.h"

namespace leonav {

void check_solve_time(const NavigatorConfig& config) {
  if (config.estimator != Estimator::kSmoother) return;
  SolveTime time;
  // Not in `main`, whose stack would stay as large. That of the thread goes to `gnss`: it is too
  // large for the threads before it.
  RealtimeThread thread;
  thread.start(
      "measure", ThreadConfig(), [&] { time = measure_solve_time(config); },
      RealtimeThread::kLargestStackBytes);
  thread.join();
  if (time.solved < kMeasuredSolves)
    return spdlog::warn("the smoother's time could not be measured");
  require_in_time(config, time);
  spdlog::info(
      "an iteration over {} keyframes with {} satellites takes {:.1f} ms of processor time here, "
      "{} {:.0f} ms",
      config.smoother.window, time.satellites, time.solve_s * 1e3,
      config.motion == MotionModel::kInertial ? "the smoother's deadline is"
                                              : "keyframes come every",
      time_to_solve(config).limit_s * 1e3);
}

}  // namespace leonav
