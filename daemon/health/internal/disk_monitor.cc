#include "daemon/health/internal/disk_monitor.h"

#include <optional>
#include <string>

namespace leonav {

std::span<const Finding> DiskMonitor::look(double now_s) {
  found_.clear();
  journal_.look(engine_->journal(), now_s);
  for (const JournalTrouble trouble : kJournalTroubles) {
    const auto reason = reason_of(trouble);
    if (!reason || !journal_.has(trouble)) continue;
    if (trouble == JournalTrouble::kFails)
      found_.add(*reason, journal_.last_failure());
    else
      found_.add(*reason);
  }
  const std::string no_checkpoint = engine_->checkpoint_error();
  if (!no_checkpoint.empty()) found_.add(HealthReason::kNoCheckpoint, no_checkpoint);
  return found_.get();
}

}  // namespace leonav
