// GaussMarkov is a first-order Gauss-Markov process of unit variance that has a rate.
#pragma once
#include <cstdint>

#include "tools/sim/motion/gaussian_generator.h"

namespace leonav::sim {

// The argument counts correlation times. At the nodes, kNodes of them to one correlation time,
//   x_(k+1) = cos(a) x_k + sin(a) w_k,   cos(a) = exp(-1 / kNodes),   w_k ~ N(0, 1),
// drawn from the stationary state, so that the correlation at nodes is exp(-difference) (Gelb,
// Applied Optimal Estimation, 3.8). Between two nodes the angle runs smoothly from 0 to a: the
// variance stays 1 everywhere, and the process is once continuously differentiable.
class GaussMarkov {
 public:
  explicit GaussMarkov(std::uint64_t key);

  struct Value {
    double value, slope;  // slope by the argument
  };
  // Arguments must not decrease from call to call, and begin at 0 or above.
  Value at(double argument);

  static constexpr double kNodes = 10.0;

 private:
  GaussianGenerator random_;
  double node_ = 0.0;  // number of the node on the left
  double left_, innovation_;
};

}  // namespace leonav::sim
