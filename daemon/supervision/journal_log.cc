#include "daemon/supervision/journal_log.h"

#include <spdlog/spdlog.h>

namespace leonav {

void JournalLog::look(const JournalHealth& health) {
  tell_name();
  tell_failure(health);
  tell_loss(health);
  const bool unsynced = health.has(JournalTrouble::kUnsynced);
  if (unsynced_.look(unsynced) && unsynced)
    spdlog::error("{}; a power cut now may cost it", health.text(JournalTrouble::kUnsynced));
  const bool undeletable = health.has(JournalTrouble::kUndeletable);
  if (undeletable_.look(undeletable) && undeletable)
    spdlog::warn("{}; look at the owner and the attributes of the files beside {}",
                 health.text(JournalTrouble::kUndeletable), journal_->path());
  tell_kept(journal_);
}

void JournalLog::tell_name() {
  if (named_ || !journal_->has_file()) return;
  named_ = true;
  if (journal_->path() != path_)
    spdlog::warn("journal {} exists and is kept; writing {}", path_, journal_->path());
}

void JournalLog::tell_failure(const JournalHealth& health) {
  const bool fails = health.has(JournalTrouble::kFails);
  if (!fails_.look(fails)) return;
  if (fails)
    spdlog::error("{}; a new piece is begun as soon as that can be done",
                  health.text(JournalTrouble::kFails));
  else
    spdlog::info("journal: written again, in piece {}", journal_->counters().piece_number.get());
}

void JournalLog::tell_loss(const JournalHealth& health) {
  const bool loses = health.has(JournalTrouble::kLoses) || health.has(JournalTrouble::kLeavesOut);
  if (!loses_.look(loses)) return;
  const JournalCounters& counters = journal_->counters();
  if (loses)
    spdlog::warn("journal: messages are left out, because the disk is too slow");
  else
    spdlog::warn(
        "journal: nothing is left out any more; {} messages and {} solutions are missing so "
        "far, because the disk was too slow",
        counters.lost_others.get(), counters.lost_solutions.get());
}

void JournalLog::tell_kept(Journal* journal) {
  while (const auto kept = journal->take_kept()) spdlog::info("journal: {} is kept", *kept);
}

}  // namespace leonav
