// WindowSolver is the interface of the solvers that minimize the window's cost.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include "core/smoother/window.h"

namespace leonav {

// One error per keyframe, in active states.
using WindowCorrections = boost::container::static_vector<EkfCorrection, kMaxWindow>;

// SolveBudget decides before every iteration but the first whether a solve may continue.
class SolveBudget {
 public:
  virtual ~SolveBudget() = default;
  // Returns whether another iteration may begin after `iterations_done`.
  virtual bool may_iterate(int iterations_done) = 0;
};

// The cost is half the sum of three kinds of terms:
//   prior            (x_0 - at)^T information (x_0 - at) - 2 gradient^T (x_0 - at)
//   process factors  e_k^T N_k^-1 e_k, with e_k = (x_k - to_k) - F_k (x_(k-1) - from_k)
//   measurements     residual^2 factor / gain_variance, at the present factors
// Motion constraints between two keyframes add a quadratic term on the first (see ProcessFactor).
class WindowSolver {
 public:
  virtual ~WindowSolver() = default;

  // Computes corrections that lead from the keyframes' states to, or towards, the minimum. Returns
  // false if the window has no unique solution, or not a finite one.
  virtual bool solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
                     WindowCorrections* corrections) = 0;

  // Sets who decides about the iterations of a solver that makes several in one solve(); nullptr:
  // nobody does.
  virtual void limit(SolveBudget*) {}
  // Returns the iterations of the last solve(). A solver that makes one is called again, with
  // weights decided anew.
  virtual int iterations() const { return 1; }
};

}  // namespace leonav
