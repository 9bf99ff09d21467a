// DiskCalls makes the system calls of the journal's thread, so that each failure and each wait is
// known.
#pragma once
#include <cerrno>
#include <utility>

#include "daemon/journal/disk_call.h"
#include "daemon/journal/journal_counters.h"
#include "daemon/threads/wall_clock.h"

namespace leonav {

// Allocates nothing after construction.
class DiskCalls {
 public:
  DiskCalls(JournalCounters* counters, DiskHook hook)
      : counters_(counters), hook_(std::move(hook)) {}

  // Calls the system, noting since when; again where a signal interrupts it. `call` returns a
  // negative number where it fails; error() is then the reason.
  template <typename Call>
  long operator()(DiskCall kind, Call&& call) {
    counters_->waiting_since_ns.set(monotonic_ns());
    error_ = hook_ ? hook_(kind) : 0;
    long result = -1;
    if (error_ == 0) {
      do {
        result = static_cast<long>(call());
      } while (result < 0 && errno == EINTR);
      if (result < 0) error_ = errno;
    }
    counters_->waiting_since_ns.set(0);
    return result;
  }

  // An errno: why the last call failed; 0: it did not.
  int error() const { return error_; }
  void set_error(int error) { error_ = error; }

 private:
  JournalCounters* counters_;
  DiskHook hook_;
  int error_ = 0;
};

}  // namespace leonav
