#include "daemon/health/journal_health.h"

namespace leonav {

std::optional<HealthReason> reason_of(JournalTrouble trouble) {
  switch (trouble) {
    case JournalTrouble::kFails:
      return HealthReason::kJournalFails;
    case JournalTrouble::kStalls:
      return HealthReason::kJournalStalled;
    case JournalTrouble::kLoses:
      return HealthReason::kJournalLost;
    case JournalTrouble::kLeavesOut:
      return HealthReason::kJournalLeftOut;
    case JournalTrouble::kUnsynced:
      return HealthReason::kJournalUnsynced;
    case JournalTrouble::kUndeletable:
      break;
  }
  return std::nullopt;
}

void JournalHealth::look(const Journal& journal, double now_s) {
  const JournalCounters& counters = journal.counters();
  // A failure may be over before it is looked at.
  note_growth(JournalTrouble::kFails, counters.failures.get(), now_s);
  if (!journal.failure().empty()) note(JournalTrouble::kFails, true, now_s);
  if (has(JournalTrouble::kFails)) failure_ = journal.last_failure();
  note(JournalTrouble::kStalls, journal.is_stalled(), now_s);
  note_growth(JournalTrouble::kLoses, counters.lost_others.get(), now_s);
  note_growth(JournalTrouble::kLeavesOut, counters.lost_solutions.get(), now_s);
  note_growth(JournalTrouble::kUnsynced, counters.unsynced.get(), now_s);
  note_growth(JournalTrouble::kUndeletable, counters.undeletable.get(), now_s);
}

void JournalHealth::note(JournalTrouble trouble, bool seen, double now_s) {
  State& state = states_[static_cast<std::size_t>(trouble)];
  if (seen) state = {true, now_s};
  if (now_s - state.last_s > kCalm_s) state.is = false;
}

void JournalHealth::note_growth(JournalTrouble trouble, std::int64_t count, double now_s) {
  note(trouble, counts_[static_cast<std::size_t>(trouble)].look(count), now_s);
}

std::string JournalHealth::text(JournalTrouble trouble) const {
  const auto reason = reason_of(trouble);
  if (!reason) return "journal: a piece cannot be deleted";
  std::string text(entry_of(*reason).text);
  if (trouble == JournalTrouble::kFails) text.append(": ").append(failure_);
  return text;
}

}  // namespace leonav
