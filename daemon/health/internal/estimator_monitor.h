// The EstimatorMonitor finds an estimator that starts over, jumps or meets what it did not expect.
#pragma once
#include <cstdint>
#include <span>

#include "daemon/health/internal/findings.h"
#include "daemon/health/internal/growth_since_look.h"
#include "daemon/health/internal/recent_growth.h"
#include "daemon/threads/counters.h"

namespace leonav {

class EstimatorMonitor {
 public:
  explicit EstimatorMonitor(const EngineCounters* counters) : counters_(counters) {}

  // Once a second; valid until the next call.
  std::span<const Finding> look();
  // Returns whether the filter has started over and no epoch has been worked on since.
  bool waits_for_epoch() const;
  // Whether the filter has started over and no epoch has come since, usable or not.
  bool heard_no_epoch() const;

 private:
  void look_at_starts();
  void look_at_jumps();

  const EngineCounters* counters_;
  std::int64_t starts_ = 0;                                   // of the filter
  std::int64_t epochs_at_start_ = 0, received_at_start_ = 0;  // accepted and received until then
  int looks_with_answer_ = 0, looks_with_gnss_ = 0;           // in a row
  GrowthSinceLook jumps_, surprising_jumps_, widened_, improbable_, constraints_left_out_;
  std::int64_t looks_widened_ = 0;  // in which a prediction was widened
  RecentGrowth recently_widened_;
  Findings found_;
};

}  // namespace leonav
