// JournalHealth judges once a second whether the journal is written, and does not flap.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "daemon/health/health_reason.h"
#include "daemon/health/internal/growth_since_look.h"
#include "daemon/journal/journal.h"

namespace leonav {

enum class JournalTrouble : std::uint8_t {
  kFails,       // cannot be written
  kStalls,      // the disk does not answer
  kLoses,       // messages are lost
  kLeavesOut,   // solutions are left out
  kUnsynced,    // the disk has not confirmed what was written
  kUndeletable  // a piece cannot be deleted
};
inline constexpr std::array kJournalTroubles = {
    JournalTrouble::kFails,     JournalTrouble::kStalls,   JournalTrouble::kLoses,
    JournalTrouble::kLeavesOut, JournalTrouble::kUnsynced, JournalTrouble::kUndeletable};

// The reason of HEALTH for it; none: it is in the log alone.
std::optional<HealthReason> reason_of(JournalTrouble trouble);

// A trouble counts until kCalm_s have passed without it, because a disk that is barely fast enough
// is in trouble every other second.
class JournalHealth {
 public:
  // `now_s`: of a clock that never goes back.
  void look(const Journal& journal, double now_s);

  bool has(JournalTrouble trouble) const { return states_[static_cast<std::size_t>(trouble)].is; }
  const std::string& last_failure() const { return failure_; }
  // For the log, in the words of HEALTH; with the file and the reason where it cannot be written.
  std::string text(JournalTrouble trouble) const;
  static constexpr double kCalm_s = 10.0;

 private:
  struct State {
    bool is = false;
    double last_s = 0.0;  // when it was last seen
  };
  void note(JournalTrouble trouble, bool seen, double now_s);
  void note_growth(JournalTrouble trouble, std::int64_t count, double now_s);

  std::array<State, kJournalTroubles.size()> states_;
  std::array<GrowthSinceLook, kJournalTroubles.size()> counts_;
  std::string failure_;
};

}  // namespace leonav
