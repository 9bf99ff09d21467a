// DescendingStep moves the window by a step, or by that part of it that does not raise the cost.
#pragma once
#include <Eigen/Core>
#include <memory>

#include "core/smoother/window.h"
#include "core/smoother/window_solver.h"

namespace leonav {

// Adds `share` of the corrections to the keyframes' states; `moved_m` is the largest step of a
// position. Returns false if a state is not finite then.
bool move_states(const WindowCorrections& corrections, double share, Window* window,
                 double* moved_m);

// A step of Gauss and Newton leads to the minimum of the cost as it was linearized. Where it is far
// from linear, as with an attitude that is wrong by tens of degrees, the cost may be higher there
// than before. Such a step is halved, at most three times (backtracking: Nocedal and Wright,
// Numerical Optimization, 2006, 3.1); if the cost rises all the same, the states stay. Allocates
// when constructed, not after.
class DescendingStep {
 public:
  // `capacity`: keyframes.
  explicit DescendingStep(int capacity);

  // Moves the states at the factors that the measurements have. Returns false if one is not finite
  // then.
  bool take(const WindowCorrections& corrections, const Eigen::Vector3d& lever_arm_b,
            Window* window);

  // Of the last step: the share taken (1, 0.5, 0.25, 0.125 or 0), and the largest step of a
  // position.
  double share() const { return share_; }
  double moved_m() const { return moved_m_; }

 private:
  std::unique_ptr<FilterState[]> before_;
  double share_ = 1.0, moved_m_ = 0.0;
};

}  // namespace leonav
