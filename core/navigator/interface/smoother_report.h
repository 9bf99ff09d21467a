// SmootherReport holds the smoother's result at one keyframe that was delivered in time.
#pragma once
#include <cstdint>

#include "core/navigator/interface/solution.h"
#include "core/smoother/smoother_status.h"

namespace leonav {

// The result of one solve.
struct SmootherReport {
  std::uint64_t sequence = 0;
  std::uint64_t index = 0;  // index k of the epoch
  SmootherStatus status = SmootherStatus::kNoFilter;
  int iterations = 0;
  bool converged = false;
  int shortened = 0;  // steps of which only a part was taken, or none, because the cost would rise
  bool left_to_chain = false;  // Ceres has found no step, and the chain has taken one
  int keyframes = 0;           // number of keyframes in the window
  int used = 0;                // measurements of this keyframe with a weight factor above zero
  // At the oldest keyframe of a full window, from all of the window; source kNone: there is none.
  // It has no protection levels.
  Solution lagged;
  Solution solution;  // source kSmoother if the solve gave a state, else kNone
};

}  // namespace leonav
