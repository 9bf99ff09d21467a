// The window's cost minimized by Ceres: the reference that the chain's own steps are judged by.
#pragma once
#include "core/smoother/window_solver.h"

namespace leonav {

// Minimizes fully, with the weights as they are, one thread, a fresh problem per call. States that
// the process does not move (an ambiguity without wander) are one unknown for all keyframes that
// have them. Allocates.
class CeresSolver final : public WindowSolver {
 public:
  // False as well where the process moves only combinations of states.
  bool solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
             WindowCorrections* corrections) override;

  int iterations() const { return iterations_; }  // of the last solve()

 private:
  int iterations_ = 0;
};

}  // namespace leonav
