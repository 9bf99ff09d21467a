// JournalScan is the result of a first pass through a log: its contents and the deadlines missed in
// it.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/messages/output_groups.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/journal_marks.h"
#include "drivers/lcm/output_schema.h"

namespace leonav {

// Contents of a log.
struct JournalScan {
  std::array<std::uint64_t, kChannelCount> messages{};  // by channel
  std::uint64_t other_messages = 0;                     // on channels that are not leonav's
  std::uint64_t unreadable_decisions = 0;
  std::vector<Decision> decisions;
  // Results of the smoother with their iterations; the last epochs have no decision yet.
  std::vector<Decision> delivered;
  OutputSchema output_schema = OutputSchema::kNewest;  // of the first output that has one
  // Messages that the disk did not take in time, over the whole journal.
  LostMessages lost;
  std::int64_t first_piece = 1;  // number of the piece that the log begins with
  std::int64_t missing = 0;      // messages in pieces that are gone
  bool truncated = false;        // the last event is cut short
  bool stopped_cleanly = false;  // its last message is the end mark, and none is missing

  std::uint64_t inputs() const;
  std::string describe() const;  // "IMU 100, GNSS_EPOCH 3, ..."
  // Returns whether a replay is the run only up to the place where messages are missing. Decisions
  // behind it are not in `decisions`, because they are of other epochs than the replay's.
  bool is_broken() const { return missing > 0 || lost.others > 0; }
  // Returns what is missing, in sentences for the user.
  std::vector<std::string> losses() const;
  // Returns whether leonavd wrote the log: its configuration first, a decision per epoch, and an
  // end mark.
  bool is_journal() const;
};

// Reads a log. Throws EventLogError for a file that is absent or damaged.
JournalScan scan_journal(const std::string& path, const std::string& prefix);

}  // namespace leonav
