// These functions read the engine's counters by what they count.
#pragma once
#include <cstdint>

#include "daemon/threads/counters.h"

namespace leonav {

// Returns the sum of an array of gauges.
std::int64_t sum(const auto& gauges) {
  std::int64_t total = 0;
  for (const Gauge& gauge : gauges) total += gauge.get();
  return total;
}

inline std::int64_t event_count(const EngineCounters& counters, EventKind kind) {
  return counters.events[static_cast<std::size_t>(kind)].get();
}

// Of the last epoch's satellites.
inline std::int64_t satellite_count(const EngineCounters& counters, Reason reason) {
  return counters.satellites_by_reason[static_cast<std::size_t>(reason)].get();
}

}  // namespace leonav
