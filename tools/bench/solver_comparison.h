// This unit solves the smoother's windows by its own chain and by Ceres, and compares results and
// times.
#pragma once
#include <string>

#include "core/navigator/interface/navigator_config.h"

namespace leonav {

// Streams the log through the smoother. From every `every`-th window on, with the weights that it
// has and estimates that are displaced by a sigma, both solvers look for the minimum; then one step
// of each is timed, of Ceres by every linear solver that it has for this. Prints the largest
// differences of cost and states, and the times.
//
// Throws std::runtime_error if one solver finds a minimum that the other does not, or if the costs
// differ by more than 1e-9 of themselves, or the states of any keyframe by more than 1e-6 of the
// newest keyframe's sigmas (those states that this has too), or by more than what the rounding of
// ranges allows if that is more: with e = 4e-9 m over the least sigma of a carrier, 3 e for the
// states and 3 e sqrt(2 / cost) for the costs. Throws too where the cost at a minimum is not known.
void compare_solvers(const NavigatorConfig& config, const std::string& log_path,
                     const std::string& prefix, int every);

}  // namespace leonav
