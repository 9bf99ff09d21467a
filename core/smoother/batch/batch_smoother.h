// This unit estimates a whole log at once: every epoch from all measurements before and after it.
#pragma once
#include <functional>
#include <vector>

#include "core/robust/igg3.h"
#include "core/smoother/batch/log_chain.h"
#include "core/smoother/batch/log_graph.h"
#include "core/smoother/batch/log_processes.h"

namespace leonav {

// Computes the corrections to the minimum of a graph at its present factors; false: there is none.
using LogSolver = std::function<bool(const LogGraph&, LogCorrections*)>;

struct BatchConfig {
  RobustConfig robust;
  int max_iterations = 20;
  // Iterations end when no position moves by more than this share of the filter's sigma.
  double converged_sigmas = 0.02;
};

// How one iteration went.
struct BatchIteration {
  double cost = 0.0;          // of the measurements, before it
  double moved_m = 0.0;       // the largest step of a position
  double moved_sigmas = 0.0;  // the largest in sigmas of the filter
  int reintegrated = 0;       // process factors, after it
};

struct BatchResult {
  bool solved = false;
  bool converged = false;
  // There were too few iterations for `processes`: nothing was extended or bridged.
  bool extension_left_out = false;
  LogProcesses::Extension extension;
  std::vector<BatchIteration> iterations;
  LogCorrections last;  // with the covariances at the solution
};

// Iterates from the states that the graph holds and leaves the smoothed ones there. Every iteration
// computes the weights, IGG-III of the residuals over their sigmas (unless `robust.enabled` is
// false: then they stay as the graph has them), and then takes a step. From the third iteration on
// the inertial factors are those of `processes`; nullptr: the filter's stay, as they do without an
// IMU. `solver` takes the steps (nullptr: the chain); the covariances are the chain's in either
// case. `progress` gets the iteration and the share of it that is done; the pass of the chain after
// the solver's iterations counts as one more.
BatchResult smooth(const BatchConfig& config, const LogSolver& solver, LogProcesses* processes,
                   const std::function<void(int, double)>& progress, LogGraph* graph);

}  // namespace leonav
