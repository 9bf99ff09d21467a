// The slips put into carriers, and what became of them.
#pragma once
#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/slip_cause.h"

namespace leonav::test {

struct Injection {
  std::size_t epoch = 0;
  SatelliteId satellite;
  int first = 0, second = 0;  // cycles
  bool flagged = false;
};

struct SlipCounts {
  long satellite_epochs = 0;  // above the mask
  long injected = 0, at_once = 0, late = 0, missed = 0;
  long false_alarms = 0;
  long false_at_slips = 0;  // of these, at epochs at which another satellite slipped
  // Arcs of one frequency that ended because a cycle is below the detectors' limit there, however
  // many satellites check it: no false alarms.
  long too_weak = 0;
  long arcs = 0, first_arcs = 0;
  std::map<SlipCause, long> share;  // of those found at once; several may share one
  std::map<SlipCause, long> false_share;
  std::map<std::string, std::pair<long, long>> by_kind;  // found at once, injected
  std::map<SlipCause, long> ends;                        // all arcs
  long clock_jumps = 0;
  std::vector<std::string> notes;
  long undecidable = 0;

  double detected() const { return static_cast<double>(at_once) / std::max(1L, injected); }
  double pairs_detected() const {
    long found = 0, all = 0;
    for (const auto& [kind, n] : by_kind) {
      if (kind.rfind("single", 0) == 0) continue;
      found += n.first;
      all += n.second;
    }
    return static_cast<double>(found) / static_cast<double>(std::max(1L, all));
  }
  double false_rate() const {
    return static_cast<double>(false_alarms) / std::max(1L, satellite_epochs);
  }
  double too_weak_rate() const {
    return static_cast<double>(too_weak) / std::max(1L, satellite_epochs);
  }
};

inline std::string kind_of(const Injection& slip, bool pair) {
  if (!pair)
    return std::abs(slip.first) == 1  ? "single frequency, 1 cycle"
           : std::abs(slip.first) < 4 ? "single frequency, 2-3"
                                      : "single frequency, 4+";
  if (slip.second == 0) return "first only";
  if (slip.first == 0) return "second only";
  if (slip.first == slip.second) return std::abs(slip.first) == 1 ? "equal, 1 cycle" : "equal, 2+";
  return "unequal";
}

}  // namespace leonav::test
