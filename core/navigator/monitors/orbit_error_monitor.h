// OrbitErrorMonitor says when the codes of a system have been found to contradict its orbits.
#pragma once
#include <array>
#include <optional>

#include "core/gnss/signals/satellite.h"

namespace leonav {

// It reports a system once, and again each time that the error has doubled.
class OrbitErrorMonitor {
 public:
  struct Finding {
    System system = System::kGps;
    double range_sigma_m = 0.0;
  };

  // Adds, per System, 1 sigma of the lasting errors of its ranges after an epoch, m (0: none;
  // LearnedErrors::lasting_sigma_m()). Returns the system with the largest error among those to be
  // reported.
  std::optional<Finding> add(const std::array<double, kSystemCount>& lasting_sigma_m);

 private:
  std::array<double, kSystemCount> reported_m_{};
};

}  // namespace leonav
