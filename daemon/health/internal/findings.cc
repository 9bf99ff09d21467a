#include "daemon/health/internal/findings.h"

namespace leonav {
namespace {

// Enough for what a run meets; no limits.
constexpr std::size_t kMostFindings = 8;

}  // namespace

Findings::Findings() : findings_(kMostFindings) {
  for (Finding& finding : findings_) finding.detail.reserve(kDetailBytes);
}

void Findings::add(HealthReason reason, std::string_view detail) {
  if (used_ == findings_.size()) findings_.emplace_back();
  Finding& finding = findings_[used_++];
  finding.reason = reason;
  finding.detail.assign(detail);
}

void append_to_list(std::string_view text, std::string* list) {
  if (!list->empty()) *list += ", ";
  *list += text;
}

}  // namespace leonav
