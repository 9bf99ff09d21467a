// A smoother that follows a drive.
#pragma once
#include <functional>
#include <memory>

#include "core/smoother/smoother.h"
#include "drive_rig.h"

namespace leonav::synthetic {

// As many iterations as may be.
struct Unlimited final : SolveBudget {
  bool may_iterate(int) override { return true; }
};

struct Stingy final : SolveBudget {
  bool may_iterate(int) override { return false; }
};

inline std::unique_ptr<Smoother> smoother_of(const Drive& drive, const SmootherConfig& config) {
  ProcessPropagationConfig repropagation;
  repropagation.ekf = drive.config();
  repropagation.imu = mems();
  repropagation.motion = Drive::motion();
  return std::make_unique<Smoother>(config, drive.config().robust, drive.lever_b(), repropagation);
}

inline std::unique_ptr<Smoother> smoother_of(const Drive& drive, int window, int iterations = 4) {
  SmootherConfig config;
  config.window = window;
  config.max_iterations = iterations;
  config.converged_sigmas = 0.01;
  return smoother_of(drive, config);
}

inline SmootherResult solve(const KeyframeInput& input, Smoother* smoother, bool take = true) {
  Unlimited budget;
  smoother->add(input);
  const SmootherResult result = smoother->solve(&budget);
  smoother->commit_or_roll_back(take);
  return result;
}

}  // namespace leonav::synthetic
