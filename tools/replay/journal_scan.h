// A first look through a log: what it holds, and which deadlines were missed when it was recorded.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/output_groups.h"
#include "drivers/lcm/channels.h"

namespace leonav {

struct JournalScan {
  std::array<std::uint64_t, kChannelCount> messages{};  // by channel
  std::uint64_t other_messages = 0;                     // on channels that are not leonav's
  std::uint64_t unreadable_decisions = 0;
  std::vector<Decision> decisions;
  // Answers of the smoother, with their iterations: those of the last epochs have no decision yet.
  std::vector<Decision> delivered;
  bool truncated = false;        // the last event is cut short
  bool stopped_cleanly = false;  // its last message says so, and none is missing

  std::uint64_t inputs() const;
  std::string describe() const;  // "IMU 100, GNSS_EPOCH 3, ..."
  // Of leonavd: it writes its configuration first, a decision per epoch, and its end.
  bool is_journal() const;
};

// Throws EventLogError for a file that is absent or damaged.
JournalScan scan_journal(const std::string& path, const std::string& prefix);

}  // namespace leonav
