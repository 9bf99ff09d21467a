#include "daemon/health/internal/load_monitor.h"

namespace leonav {

std::span<const Finding> LoadMonitor::look() {
  found_.clear();
  const EngineCounters& counters = engine_->counters();
  if (misses_.look(counters.misses.get())) found_.add(HealthReason::kDeadlineMissed);
  if (smoother_misses_.look(counters.smoother_misses.get()))
    found_.add(HealthReason::kSmootherLate);
  if (smoother_failures_.look(counters.smoother_failures.get()))
    found_.add(HealthReason::kSmootherFailed);
  if (keyframes_skipped_.look(counters.keyframes_skipped.get()))
    found_.add(HealthReason::kKeyframesSkipped);
  const std::uint64_t waits =
      engine_->inertial_ring().waits + engine_->gnss_ring().waits + engine_->out_ring().waits;
  if (waits_.look(static_cast<std::int64_t>(waits))) found_.add(HealthReason::kQueueFull);
  return found_.get();
}

}  // namespace leonav
