// SteadyRun tells epochs of another time from a backlog that catches up.
#pragma once
#include <cmath>
#include <cstdint>

#include "core/navigator/sequencer/internal/time_step_monitor.h"

namespace leonav {

// SteadyRun follows epochs that contradict the IMU. Where two clocks differ, the time between an
// epoch and the newest IMU sample stays the same, but for the latency of GNSS, which may vary by
// `tolerance_ns`. Epochs that a link held back while it stalled come faster than they were
// measured, so that this time becomes shorter. Once it has changed by more than the tolerance, a
// new run begins. A backlog that is sent only a little faster cannot be told from another time.
class SteadyRun {
 public:
  SteadyRun(std::int64_t max_step_ns, std::int64_t tolerance_ns)
      : run_(0, max_step_ns), tolerance_ns_(tolerance_ns) {}

  void clear() { run_.clear(); }
  void add(GpsTime epoch, GpsTime imu_time) {
    const std::int64_t lag_ns = nanoseconds_between(imu_time, epoch);
    if (std::abs(lag_ns - first_lag_ns_) > tolerance_ns_) run_.clear();
    run_.reject(epoch);
    if (run_.run() == 1) first_lag_ns_ = lag_ns;
  }
  // Returns the number of epochs of the run, and the time from the first to the last of them.
  int run() const { return run_.run(); }
  std::int64_t run_ns() const { return run_.run_ns(); }

 private:
  TimeStepMonitor run_;
  std::int64_t tolerance_ns_;
  std::int64_t first_lag_ns_ = 0;  // of the run
};

}  // namespace leonav
