// This function compares the window's cost at two estimates.
#pragma once
#include <Eigen/Core>

#include "core/smoother/window.h"

namespace leonav {

// Returns the cost (core/smoother/window_solver.h) at the keyframes' states minus that at `before`,
// which has one state per keyframe; both at the factors that the measurements have. The noise of a
// process is inverted here, by its Cholesky root; a state without noise, which goes on as the
// process says at both estimates, has no term. NaN where a noise is not definite: then it is not
// known. Allocates nothing.
double cost_rise(const Window& window, const FilterState* before,
                 const Eigen::Vector3d& lever_arm_b);

}  // namespace leonav
