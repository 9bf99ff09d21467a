// Trajectory gives the smoothed states at the keyframes, and at the IMU's samples between them.
#pragma once
#include <Eigen/Core>
#include <functional>

#include "core/navigator/interface/solution.h"
#include "core/navigator/interface/solution_conversion.h"
#include "core/smoother/batch/batch_smoother.h"

namespace leonav {

// What a trajectory is made of: from all of the log, or only from what came before each epoch.
enum class Estimate { kSmoothed, kForward };

// Trajectory refers to a graph and its result, which must outlive it.
class Trajectory {
 public:
  Trajectory(const LogGraph& graph, const BatchResult& result, Estimate estimate)
      : graph_(graph), result_(result), estimate_(estimate) {}

  // Returns the solution at keyframe `k`.
  Solution at(int k) const;
  // Calls `use` with the solution at every keyframe and, where an attitude is known at both sides,
  // at every IMU sample between them: the samples are integrated from the keyframe before, and what
  // they then miss the next one by is taken off in proportion to time. Sigmas go over linearly.
  void for_each_sample(const std::function<void(const Solution&)>& use) const;

 private:
  CoreState state(int k) const;
  PvaCovariance covariance(int k) const;
  void for_each_sample_before(int k, const std::function<void(const Solution&)>& use) const;

  const LogGraph& graph_;
  const BatchResult& result_;
  Estimate estimate_;
};

}  // namespace leonav
