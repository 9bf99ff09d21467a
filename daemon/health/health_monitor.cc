#include "daemon/health/health_monitor.h"

#include "daemon/health/internal/health_message.h"

namespace leonav {

HealthMonitor::HealthMonitor(Engine* engine, const NavigatorConfig& config)
    : engine_(engine),
      inputs_(&engine->counters(), config),
      conventions_(&engine->counters()),
      estimator_(&engine->counters()),
      solution_(&engine->counters(), config),
      measurements_(&engine->counters()),
      load_(engine),
      disk_(engine),
      message_(std::make_unique<HealthMessage>()) {}

HealthMonitor::~HealthMonitor() = default;

std::span<const std::uint8_t> HealthMonitor::next(double now_s, std::string_view stalled_threads) {
  reasons_.begin(now_s);
  if (!stalled_threads.empty()) reasons_.raise(HealthReason::kThreadHangs, stalled_threads);
  raise(inputs_.look(now_s));
  raise(conventions_.look(now_s));
  raise(estimator_.look());
  raise(solution_.look(now_s, &inputs_, estimator_));
  raise(measurements_.look());
  raise(load_.look());
  raise(disk_.look(now_s));
  HealthSummary summary;
  summary.sequence = ++sequence_;
  summary.status = status();
  summary.why = why();
  summary.source = solution_.source();
  summary.uptime_s = now_s;
  return message_->encode(summary, engine_);
}

void HealthMonitor::raise(std::span<const Finding> findings) {
  for (const Finding& finding : findings) reasons_.raise(finding.reason, finding.detail);
}

}  // namespace leonav
