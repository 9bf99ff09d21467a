#include "daemon/health/internal/convention_monitor.h"

#include <utility>

#include "daemon/text/convention_text.h"

namespace leonav {

std::span<const Finding> ConventionMonitor::look() {
  found_.clear();
  std::array<std::optional<std::int64_t>, kConventionCount> milli;
  for (std::size_t i = 0; i < kConventionCount; ++i) {
    if (counters_->conventions[i].get() != 0) milli[i] = counters_->convention_milli[i].get();
  }
  if (std::exchange(suspected_, milli) != milli) {
    suspicions_.clear();
    for (std::size_t i = 0; i < kConventionCount; ++i) {
      if (!milli[i]) continue;
      const double value = static_cast<double>(*milli[i]) * 1e-3;
      const std::string text = convention_text(static_cast<Convention>(i), value);
      suspicions_ += (suspicions_.empty() ? "" : "; ") + text;
    }
  }
  if (!suspicions_.empty()) found_.add(HealthReason::kConvention, suspicions_);
  return found_.get();
}

}  // namespace leonav
