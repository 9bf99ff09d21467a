// Notices a receiver of which nothing can be used, and why: a clock 110 ms off, for one, makes
// every pseudorange implausible.
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

  // The satellites of one epoch that had any. A finding when, for the fifth epoch in a row, all but
  // those below the mask or of systems switched off were left out for one and the same reason;
  // again only after another epoch has come between.
  std::optional<Finding> add(std::span<const SatelliteReport> satellites);

 private:
  static constexpr int kEpochs = 5;  // one or two may be a burst of interference

  Reason reason_ = Reason::kUsed;
  int epochs_ = 0;
};

}  // namespace leonav
