#include "daemon/health/internal/convention_monitor.h"

#include <utility>

#include "daemon/text/convention_text.h"

namespace leonav {
namespace {

constexpr double kHold_s = 2.0 * kFoundAgain_s;

}  // namespace

// `lasts`: the stage finds it again while it lasts.
void ConventionMonitor::look_at(const ConventionGauge& gauge, bool lasts, double now_s,
                                Suspicion* one) {
  const std::int64_t events = gauge.events.get();
  const bool is_new = std::exchange(one->events, events) != events;
  if (events <= gauge.void_events.get()) {
    one->is_active = false;
  } else if (is_new) {
    one->last_s = now_s;
    one->is_active = true;
  } else if (lasts && now_s - one->last_s > kHold_s) {
    one->is_active = false;
  }
}

std::span<const Finding> ConventionMonitor::look(double now_s) {
  found_.clear();
  bool has_changed = false;
  for (std::size_t i = 0; i < kConventionCount; ++i) {
    Suspected& one = suspected_[i];
    const ConventionGauge &once = counters_->conventions[i],
                          &lasting = counters_->lasting_conventions[i];
    const bool was_active = one.is_active();
    look_at(once, false, now_s, &one.once);
    look_at(lasting, true, now_s, &one.lasting);
    if (one.is_active() && !was_active)
      one.milli = (one.once.is_active ? once : lasting).milli.get();
    has_changed = has_changed || one.is_active() != was_active;
  }
  if (has_changed) {
    suspicions_.clear();
    for (std::size_t i = 0; i < kConventionCount; ++i) {
      if (!suspected_[i].is_active()) continue;
      const double value = static_cast<double>(suspected_[i].milli) * 1e-3;
      const std::string text = convention_text(static_cast<Convention>(i), value);
      suspicions_ += (suspicions_.empty() ? "" : "; ") + text;
    }
  }
  if (!suspicions_.empty()) found_.add(HealthReason::kConvention, suspicions_);
  return found_.get();
}

}  // namespace leonav
