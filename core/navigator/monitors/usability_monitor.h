// UsabilityMonitor detects a receiver of which nothing can be used, with the reason: a clock that
// is 110 ms off, for example, makes every pseudorange implausible.
#pragma once
#include <optional>
#include <span>

#include "core/navigator/interface/epoch_report.h"

namespace leonav {

class UsabilityMonitor {
 public:
  struct Finding {
    Reason reason = Reason::kUsed;
    int satellites = 0;
  };

  // Adds the satellites of one epoch that had any. Returns a finding when, for the fifth epoch in a
  // row, all satellites but those below the mask or of disabled systems were left out for the same
  // reason; again only after another kind of epoch.
  std::optional<Finding> add(std::span<const SatelliteReport> satellites);

 private:
  static constexpr int kEpochs = 5;  // one or two may be a burst of interference

  Reason reason_ = Reason::kUsed;
  int epochs_ = 0;
};

}  // namespace leonav
