#include "daemon/health/active_reasons.h"

#include <algorithm>
#include <utility>

namespace leonav {

void ActiveReasons::raise(HealthReason reason, std::string detail) {
  cases_[static_cast<std::size_t>(reason)] = {true, now_s_, std::move(detail)};
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

std::string ActiveReasons::text() const {
  std::string text;
  for (const HealthStatus status : {HealthStatus::kFault, HealthStatus::kDegraded}) {
    for (const HealthReasonEntry& entry : health_reasons()) {
      if (entry.status != status || !is_active(entry)) continue;
      const std::string& detail = cases_[static_cast<std::size_t>(entry.reason)].detail;
      std::string sentence(entry.text);
      // A reason without a text of its own is its detail.
      if (!detail.empty()) sentence += sentence.empty() ? detail : " (" + detail + ")";
      if (!entry.remedy.empty()) sentence += ": " + std::string(entry.remedy);
      text += (text.empty() ? "" : "; ") + sentence;
    }
  }
  return text;
}

}  // namespace leonav
