// UsabilityMonitor finds that all satellites of a receiver are excluded for one and the same
// reason.
//
// For example, a receiver clock that is off by 110 ms makes every pseudorange implausible.
#pragma once
#include <optional>
#include <span>

#include "core/navigator/interface/epoch_report.h"

namespace leonav {

// UsabilityMonitor counts consecutive epochs in which one reason excluded all satellites.
class UsabilityMonitor {
 public:
  // The common reason, and how many satellites it excluded.
  struct Finding {
    Reason reason = Reason::kUsed;
    int satellites = 0;
  };

  // Adds the satellites of one epoch with GNSS. Returns a finding in the fifth epoch in a row in
  // which one reason excluded all satellites, not counting those below the elevation mask or of
  // disabled systems. It returns another one only after an epoch without this state.
  std::optional<Finding> add(std::span<const SatelliteReport> satellites);

 private:
  Reason reason_ = Reason::kUsed;
  int epochs_ = 0;
};

}  // namespace leonav
