#include "daemon/health/internal/load_monitor.h"

namespace leonav {
namespace {

constexpr const char* kDrill = "drill";

}  // namespace

// Where a drill is on, the reasons that it causes say so: its warning at the start is soon
// forgotten.
std::span<const Finding> LoadMonitor::look() {
  found_.clear();
  const EngineCounters& counters = engine_->counters();
  const DaemonConfig& config = engine_->config();
  if (misses_.look(counters.misses.get())) found_.add(HealthReason::kDeadlineMissed);
  if (smoother_misses_.look(counters.smoother_misses.get()))
    found_.add(HealthReason::kSmootherLate, config.drill.late_solve_every > 0 ? kDrill : "");
  if (smoother_failures_.look(counters.smoother_failures.get()))
    found_.add(HealthReason::kSmootherFailed,
               config.navigator.smoother.drill_failure_every > 0 ? kDrill : "");
  if (keyframes_skipped_.look(counters.keyframes_skipped.get()))
    found_.add(HealthReason::kKeyframesSkipped);
  const std::uint64_t waits =
      engine_->inertial_ring().waits + engine_->gnss_ring().waits + engine_->out_ring().waits;
  if (waits_.look(static_cast<std::int64_t>(waits))) found_.add(HealthReason::kQueueFull);
  return found_.get();
}

}  // namespace leonav
