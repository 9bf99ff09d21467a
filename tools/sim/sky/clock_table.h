// ClockTable is a clock with random noise: offset and drift at equidistant nodes.
#pragma once
#include <vector>

#include "tools/sim/motion/gaussian_generator.h"

namespace leonav::sim {

// Initial values and noise of a clock.
struct ClockErrors {
  double offset_s = 0.0, drift = 0.0;
  double phase_walk_s = 0.0;  // white frequency noise, s/sqrt(s)
  double drift_walk = 0.0;    // random walk of the frequency, 1/sqrt(s)
};

// Offset and rate are continuous: a cubic through the nodes' offsets and drifts.
class ClockTable {
 public:
  ClockTable(double first_s, double last_s, double step_s, const ClockErrors& errors,
             GaussianGenerator random);

  struct Value {
    double offset_s, drift;
  };
  Value at(double t) const;

 private:
  double first_s_, step_s_;
  std::vector<Value> nodes_;
};

}  // namespace leonav::sim
