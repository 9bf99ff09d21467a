#include "daemon/health/journal_health.h"

#include <utility>

namespace leonav {

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
  const std::int64_t before = std::exchange(counts_[static_cast<std::size_t>(trouble)], count);
  note(trouble, count > before, now_s);
}

std::string JournalHealth::text(JournalTrouble trouble) const {
  switch (trouble) {
    case JournalTrouble::kFails:
      return "journal: " + failure_;
    case JournalTrouble::kStalls:
      return "journal: the disk does not answer";
    case JournalTrouble::kLoses:
      return "journal: messages are lost";
    case JournalTrouble::kLeavesOut:
      return "journal: solutions are left out";
    case JournalTrouble::kUnsynced:
      return "journal: the disk has not confirmed what was written";
    default:
      return "journal: a piece cannot be deleted";
  }
}

}  // namespace leonav
