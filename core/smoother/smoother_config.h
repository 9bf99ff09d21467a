// Tuning of the sliding-window smoother. SI units.
#pragma once

namespace leonav {

struct SmootherConfig {
  int window = 20;                    // keyframes, 1 to kMaxWindow
  double keyframe_interval_s = 0.95;  // epochs nearer to the last keyframe are not one
  int max_iterations = 4;             // linearizations of one solve
  bool reweigh = true;  // at every iteration, over the whole window; false: the filter's weights
  // Errors of a satellite's code nearer to each other than this count as one where the mean of its
  // residuals over the window is judged; 0: each code by itself.
  double code_alike_s = 5.0;
  // Of one solve: after so long no further iteration begins. Only in the service; how many
  // iterations came of it is in the journal. 0: until the deadline.
  double time_limit_s = 0.25;
  // Largest correction of a position, in sigmas of the filter's, that ends a solve.
  double converged_sigmas = 0.01;
};

}  // namespace leonav
