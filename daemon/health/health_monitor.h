// The HealthMonitor evaluates once a second whether the daemon works, and why not.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "daemon/engine/engine.h"
#include "daemon/health/active_reasons.h"
#include "daemon/health/internal/convention_monitor.h"
#include "daemon/health/internal/disk_monitor.h"
#include "daemon/health/internal/estimator_monitor.h"
#include "daemon/health/internal/input_monitor.h"
#include "daemon/health/internal/load_monitor.h"
#include "daemon/health/internal/measurement_monitor.h"
#include "daemon/health/internal/solution_monitor.h"
#include "daemon/health/journal_health.h"
#include "daemon/health/keep_rule.h"

namespace leonav {

class HealthMessage;

// It runs in `main`. The monitors read the engine's counters and return what they have found; here
// it becomes one status and one message. docs/operations/health.md has every reason.
class HealthMonitor {
 public:
  HealthMonitor(Engine* engine, const NavigatorConfig& config);
  ~HealthMonitor();
  HealthMonitor(const HealthMonitor&) = delete;
  HealthMonitor& operator=(const HealthMonitor&) = delete;

  // The encoded message; valid until the next call. `now_s`: of a clock that never goes back, 0 at
  // construction. Silence is measured with it and not with data time, which stands still when all
  // inputs end. `stalled_threads`: by the ThreadMonitor.
  std::span<const std::uint8_t> next(std::string_view stalled_threads = {}) {
    return next(uptime_s(), stalled_threads);
  }
  std::span<const std::uint8_t> next(double now_s, std::string_view stalled_threads = {});
  // The status and its reasons at the last call.
  HealthStatus status() const { return reasons_.status(); }
  const std::string& why() { return reasons_.text(); }
  // Inputs that break a convention, with the remedies; part of why(). Empty: none.
  const std::string& suspicions() const { return conventions_.suspicions(); }
  // Whether there was an answer at the last call; part of status().
  Fault fault() const { return solution_.fault(); }
  const JournalHealth& journal() const { return disk_.journal(); }

 private:
  double uptime_s() const { return static_cast<double>(uptime_.nanoseconds()) * 1e-9; }
  void raise(std::span<const Finding> findings);

  Engine* engine_;
  InputMonitor inputs_;
  ConventionMonitor conventions_;
  EstimatorMonitor estimator_;
  SolutionMonitor solution_;
  MeasurementMonitor measurements_;
  LoadMonitor load_;
  DiskMonitor disk_;
  ActiveReasons reasons_;
  Stopwatch uptime_;
  std::uint64_t sequence_ = 0;
  std::unique_ptr<HealthMessage> message_;
};

}  // namespace leonav
