// CeresSolver minimizes the window's cost by Ceres, as the reference for the steps of RtsSolver.
#pragma once
#include "core/smoother/window_solver.h"

namespace leonav {

// CeresSolver minimizes the cost fully, at the present weights, in one thread, with a fresh problem
// per call.
//
// A state that the process does not change (an ambiguity without a random walk) is one unknown for
// all keyframes that have it. Allocates memory; not for the service.
class CeresSolver final : public WindowSolver {
 public:
  // Returns false also where the process changes only combinations of states.
  bool solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
             WindowCorrections* corrections) override;

  int iterations() const { return iterations_; }  // iterations of the last solve()

 private:
  int iterations_ = 0;
};

}  // namespace leonav
