#include "daemon/health/active_reasons.h"

#include <algorithm>

#include "daemon/health/internal/findings.h"

namespace leonav {
namespace {

// Of what a run meets; no limits.
constexpr std::size_t kReasonBytes = 2048;

}  // namespace

ActiveReasons::ActiveReasons() {
  for (Case& one : cases_) one.detail.reserve(kDetailBytes);
  text_.reserve(kReasonBytes);
}

void ActiveReasons::raise(HealthReason reason, std::string_view detail) {
  Case& one = cases_[static_cast<std::size_t>(reason)];
  one.was_raised = true;
  one.last_s = now_s_;
  one.detail.assign(detail);
}

bool ActiveReasons::is_active(const HealthReasonEntry& entry) const {
  const Case& one = cases_[static_cast<std::size_t>(entry.reason)];
  return one.was_raised && now_s_ - one.last_s <= entry.hold_s;
}

HealthStatus ActiveReasons::status() const {
  HealthStatus worst = HealthStatus::kOk;
  for (const HealthReasonEntry& entry : health_reasons()) {
    if (is_active(entry)) worst = std::max(worst, entry.status);
  }
  return worst;
}

const std::string& ActiveReasons::text() {
  text_.clear();
  for (const HealthStatus status : {HealthStatus::kFault, HealthStatus::kDegraded}) {
    for (const HealthReasonEntry& entry : health_reasons()) {
      if (entry.status != status || !is_active(entry)) continue;
      const std::string& detail = cases_[static_cast<std::size_t>(entry.reason)].detail;
      if (!text_.empty()) text_ += "; ";
      text_ += entry.text;
      // A reason without a text of its own is its detail.
      if (entry.text.empty())
        text_ += detail;
      else if (!detail.empty())
        text_.append(" (").append(detail).append(")");
      if (!entry.remedy.empty()) text_.append(": ").append(entry.remedy);
    }
  }
  return text_;
}

}  // namespace leonav
