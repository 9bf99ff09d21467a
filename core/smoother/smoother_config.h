// SmootherConfig holds the settings of the sliding-window smoother, in SI units.
#pragma once

namespace leonav {

// What takes the steps of the window.
enum class SmootherSolver : unsigned char {
  kChain,  // forward and backward pass over the keyframes; allocates nothing
  kCeres   // Levenberg-Marquardt of Ceres; allocates
};

// The robust weights that Ceres uses.
enum class CeresLoss : unsigned char {
  kIgg3,  // IGG-III, decided before the solve as for the chain
  kHuber,
  kCauchy
};

// What a solve that fails on purpose suffers from.
enum class DrilledFailure : unsigned char {
  kSingular,  // before it the newest keyframe's position is no number
  kDiverged   // behind its steps that position is 100 km off
};

// Settings of the smoother; the names of the configuration keys are those of group `smoother`.
struct SmootherConfig {
  SmootherSolver solver = SmootherSolver::kChain;
  CeresLoss ceres_loss = CeresLoss::kIgg3;
  int window = 20;                    // keyframes, 1 to kMaxWindow
  double keyframe_interval_s = 0.95;  // an epoch closer to the last keyframe is not a keyframe
  int max_iterations = 2;             // linearizations of one solve; for Ceres, its iterations
  bool reweigh = true;  // decide weights anew at every iteration; false: the filter's weights
  // So long after its epoch a measurement's weight may still change.
  double reweigh_s = 5.0;
  // Errors of a satellite's code less than this apart count as one when the mean of its residuals
  // over these epochs is tested; 0: each code is tested by itself only.
  double code_alike_s = 5.0;
  // Time within which a further iteration of a solve must end, at the pace of those before it; 0:
  // no limit but the deadline. It acts in the service with an IMU only: the journal records the
  // number of iterations that resulted.
  double time_limit_s = 0.25;
  // A solve ends when the largest correction of a position is below this, in sigmas of the filter's
  // position or, if it is smaller, the window's. The states move on from solve to solve, so that a
  // shorter step leaves next to nothing of what is not linear.
  double converged_sigmas = 1.0;

  bool fixed_lag = true;  // give the oldest keyframe's state too, once the window is full

  // A drill: the solve of every so many-th epoch fails on purpose. 0: none does.
  int drill_failure_every = 0;
  DrilledFailure drill_failure = DrilledFailure::kSingular;

  bool operator==(const SmootherConfig&) const = default;
};

}  // namespace leonav
