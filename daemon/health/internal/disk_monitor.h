// The DiskMonitor finds a journal or a checkpoint that cannot be written.
#pragma once
#include <span>

#include "daemon/engine/engine.h"
#include "daemon/health/internal/findings.h"
#include "daemon/health/journal_health.h"

namespace leonav {

// The navigation needs no journal: what is missing in it is counted, and the next piece may be
// whole.
class DiskMonitor {
 public:
  explicit DiskMonitor(const Engine* engine) : engine_(engine) {}

  // Once a second; valid until the next call. `now_s`: of a clock that never goes back.
  std::span<const Finding> look(double now_s);
  const JournalHealth& journal() const { return journal_; }

 private:
  const Engine* engine_;
  JournalHealth journal_;
  Findings found_;
};

}  // namespace leonav
