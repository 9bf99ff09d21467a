// OrbitErrorMonitor says when the codes of a system have been found to contradict its orbits.
#pragma once
#include <array>
#include <optional>

#include "core/filter/error_model/lasting_errors.h"

namespace leonav {

// It reports a system once, and again each time that its error has doubled.
class OrbitErrorMonitor {
 public:
  // Adds what is known after an epoch. Returns the largest 1 sigma of a range, m, among the systems
  // that are to be reported, if there are any.
  std::optional<double> add(const LastingErrors& errors);

 private:
  std::array<double, kSystemCount> reported_m_{};
};

}  // namespace leonav
