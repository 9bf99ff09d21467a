// The MeasurementMonitor finds satellites without orbits, and measurements that contradict the
// answer or each other.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "daemon/health/internal/findings.h"
#include "daemon/health/internal/recent_growth.h"
#include "daemon/threads/counters.h"

namespace leonav {

class MeasurementMonitor {
 public:
  explicit MeasurementMonitor(const EngineCounters* counters) : counters_(counters) {}

  // Once a second; valid until the next call.
  std::span<const Finding> look();

 private:
  void look_at_orbits();
  void look_at_contradictions();
  void look_at_lasting_errors();

  const EngineCounters* counters_;
  std::int64_t most_precise_ = 0;  // satellites by precise states since there were none
  RecentGrowth measurements_, contradicting_;
  RecentGrowth satellite_faults_{600};
  std::string detail_;  // of the reason that is looked at
  Findings found_;
};

}  // namespace leonav
