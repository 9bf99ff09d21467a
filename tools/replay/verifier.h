// Verifier compares regenerated outputs with those that a journal recorded, byte by byte.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/messages/output_groups.h"
#include "drivers/lcm/event_log.h"
#include "tools/replay/journal_scan.h"

namespace leonav {

// Verifier reads the journal once per group, in parallel with the replay, so that memory is bounded
// for runs of any length.
class Verifier {
 public:
  // `scan`: of the journal. Groups that it holds in part are compared as far as it holds them, and
  // nothing behind the first place where something is missing that a replay needs.
  Verifier(const std::string& journal, const std::string& prefix, const JournalScan& scan);

  // Compares the next output of a group with the journal.
  void compare(std::size_t group, ByteSpan regenerated);
  // Ends the comparison after the last output. `complete`: the journal was stopped cleanly, so that
  // it must hold all outputs.
  void finish(bool complete);

  std::uint64_t compared() const { return compared_; }
  std::uint64_t differences() const { return differences_; }
  // Returns the number of outputs that the journal was not to hold (journal.outputs), or that were
  // left out.
  std::uint64_t unrecorded() const { return unrecorded_; }
  // Returns the number of outputs beyond the end of a journal that was cut.
  std::uint64_t beyond_end() const { return beyond_end_; }
  // Describes the first difference in words; empty: none.
  const std::string& first_difference() const { return first_difference_; }

 private:
  struct Group {
    std::unique_ptr<EventLogReader> log;
    std::uint64_t count = 0;
    bool ended = false;
    LogEvent event;      // the next one, where `waits`
    bool waits = false;  // read, and not compared as yet
  };
  bool is_absent(std::size_t group) const;
  bool was_left_out(std::size_t group, ByteSpan regenerated);
  // Reads the next recorded message of the group, unless one waits; false if there is none.
  bool next_recorded(std::size_t group);
  void differ(std::size_t group, const std::string& what);

  std::string prefix_;
  std::array<Group, kOutputGroups.size()> groups_;
  RecordedOutputs outputs_;
  bool thinned_;  // SOLUTION may be missing
  std::uint64_t compared_ = 0, differences_ = 0, beyond_end_ = 0, unrecorded_ = 0;
  std::string first_difference_;
};

}  // namespace leonav
