// A JournalFile is written by system calls alone, so that each failure and each wait is known.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include "daemon/journal/journal_counters.h"

namespace leonav {

// Locked (flock) while it is open, so that no other daemon deletes or renames it. Allocates
// nothing. Functions that fail leave the reason in error(), an errno.
class JournalFile {
 public:
  // `before_call`: for tests; called before each call that may wait for the disk. It may wait
  // itself, and what it returns, unless 0, is the errno with which the call fails.
  JournalFile(JournalCounters* counters, std::function<int()> before_call)
      : counters_(counters), before_call_(std::move(before_call)) {}
  ~JournalFile() { close(); }
  JournalFile(const JournalFile&) = delete;
  JournalFile& operator=(const JournalFile&) = delete;

  // `name` in `folder`. `create`: a file of that name must not exist.
  bool open(int folder, const char* name, bool create);
  // Appends bytes; returns how many were written, all of them unless it fails.
  std::size_t write(std::span<const std::uint8_t> bytes);
  // Cuts off what was written beyond `size`.
  void truncate(std::int64_t size);
  bool sync();
  void close();

  bool is_open() const { return descriptor_ >= 0; }
  // Whether it is a file on a disk, not a pipe or a device.
  bool is_regular() const { return regular_; }
  int error() const { return error_; }

 private:
  // Calls the system, noting since when; the call returns a negative number where it fails.
  template <typename Call>
  long wait_for(Call&& call);

  JournalCounters* counters_;
  std::function<int()> before_call_;
  int descriptor_ = -1;
  bool regular_ = false;
  int error_ = 0;
};

}  // namespace leonav
