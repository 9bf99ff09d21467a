// Compares regenerated outputs with those that a journal recorded, byte for byte.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/output_groups.h"
#include "drivers/lcm/event_log.h"

namespace leonav {

// Reads the journal once per group side by side with the replay, so that memory stays bounded
// however long the run was.
class Verifier {
 public:
  Verifier(const std::string& journal, const std::string& prefix);

  void compare(std::size_t group, ByteSpan regenerated);
  // After the last output. `complete`: the journal was stopped cleanly, so that it must hold all.
  void finish(bool complete);

  std::uint64_t compared() const { return compared_; }
  std::uint64_t differences() const { return differences_; }
  // Outputs that a journal that was cut does not hold.
  std::uint64_t beyond_end() const { return beyond_end_; }
  // In words; empty: none.
  const std::string& first_difference() const { return first_difference_; }

 private:
  struct Group {
    std::unique_ptr<EventLogReader> log;
    std::uint64_t count = 0;
    bool ended = false;
  };
  // The next recorded message of the group into event_; false: no more.
  bool next_recorded(std::size_t group);
  void differ(std::size_t group, const std::string& what);

  std::string prefix_;
  std::array<Group, kOutputGroups.size()> groups_;
  LogEvent event_;
  std::uint64_t compared_ = 0, differences_ = 0, beyond_end_ = 0;
  std::string first_difference_;
};

}  // namespace leonav
