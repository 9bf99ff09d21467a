// A SmootherReport holds the smoother's answer at one keyframe, if it came in time.
#pragma once
#include <cstdint>

#include "core/navigator/interface/solution.h"
#include "core/smoother/smoother_status.h"

namespace leonav {

struct SmootherReport {
  std::uint64_t sequence = 0;
  std::uint64_t index = 0;  // k
  SmootherStatus status = SmootherStatus::kNoFilter;
  int iterations = 0;
  bool converged = false;
  int keyframes = 0;  // in the window
  int used = 0;       // measurements of this keyframe with a weight
  Solution solution;  // source kSmoother if the answer is its own, else kNone
};

}  // namespace leonav
