// Verifier compares regenerated outputs with those that a journal recorded, byte by byte.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/messages/output_groups.h"
#include "daemon/messages/output_selection.h"
#include "drivers/lcm/event_log.h"

namespace leonav {

// Verifier reads the journal once per group, in parallel with the replay, so that memory is bounded
// for runs of any length.
class Verifier {
 public:
  // Outputs that a piece of the journal was not to hold are passed over, and so are as many
  // SOLUTION as a mark LOST says were left out before it; nothing is compared behind the first
  // place where something is missing that a replay needs.
  Verifier(const std::string& journal, const std::string& prefix);

  // Compares the next output of a group, which `channel` belongs to, with the journal.
  void compare(Channel channel, std::size_t group, ByteSpan regenerated);
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
    LogEvent event;                                    // the next one, where `waits`
    bool waits = false;                                // read, and not compared as yet
    std::uint64_t left_out = 0;                        // before the next one, as marks say
    OutputSelection selection{RecordedOutputs::kAll};  // of the piece that it is in
    bool changes = false;  // a piece with other outputs begins before the next one
  };
  // Whether an output is to be compared with the next recorded one of its group.
  bool is_recorded(Channel channel, std::size_t group, ByteSpan regenerated);
  bool begins_again(Group* state, ByteSpan regenerated);
  bool was_left_out(std::size_t group);
  // Reads the next recorded message of the group, unless one waits; false if there is none.
  bool next_recorded(std::size_t group);
  void differ(std::size_t group, const std::string& what);

  std::string prefix_;
  std::array<Group, kOutputGroups.size()> groups_;
  std::uint64_t compared_ = 0, differences_ = 0, beyond_end_ = 0, unrecorded_ = 0;
  std::string first_difference_;
};

}  // namespace leonav
