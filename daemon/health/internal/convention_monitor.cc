#include "daemon/health/internal/convention_monitor.h"

#include <utility>

#include "daemon/text/convention_text.h"

namespace leonav {
namespace {

constexpr double kHold_s = 2.0 * kFoundAgain_s;

}  // namespace

std::span<const Finding> ConventionMonitor::look(double now_s) {
  found_.clear();
  bool has_changed = false;
  for (std::size_t i = 0; i < kConventionCount; ++i) {
    Suspicion& one = suspected_[i];
    const bool was_active = one.is_active;
    const std::int64_t events = counters_->conventions[i].get();
    if (std::exchange(one.events, events) != events) {
      one.last_s = now_s;
      one.is_active = true;
      if (!was_active) one.milli = counters_->convention_milli[i].get();
    } else if (events == counters_->lasting_conventions[i].get() && now_s - one.last_s > kHold_s) {
      one.is_active = false;
    }
    has_changed = has_changed || one.is_active != was_active;
  }
  if (has_changed) {
    suspicions_.clear();
    for (std::size_t i = 0; i < kConventionCount; ++i) {
      if (!suspected_[i].is_active) continue;
      const double value = static_cast<double>(suspected_[i].milli) * 1e-3;
      const std::string text = convention_text(static_cast<Convention>(i), value);
      suspicions_ += (suspicions_.empty() ? "" : "; ") + text;
    }
  }
  if (!suspicions_.empty()) found_.add(HealthReason::kConvention, suspicions_);
  return found_.get();
}

}  // namespace leonav
