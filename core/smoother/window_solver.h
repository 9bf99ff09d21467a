// The window's cost and who minimizes it.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include "core/smoother/window.h"

namespace leonav {

// One error per keyframe, in active states.
using WindowCorrections = boost::container::static_vector<EkfCorrection, kMaxWindow>;

// The cost is half the sum of the prior's, every link's (link_error, weighed by N^-1) and every
// measurement's (residual^2 factor / gain_variance), in the factors as they are.
class WindowSolver {
 public:
  virtual ~WindowSolver() = default;

  // Corrections that lead from the keyframes' states to, or towards, the least cost. False: the
  // window has no unique solution, or not a finite one.
  virtual bool solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
                     WindowCorrections* corrections) = 0;
};

}  // namespace leonav
