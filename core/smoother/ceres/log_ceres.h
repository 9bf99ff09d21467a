// This unit minimizes the cost of a whole log by Ceres (http://ceres-solver.org).
#pragma once
#include <string>

#include "core/smoother/batch/log_chain.h"
#include "core/smoother/batch/log_graph.h"

namespace leonav {

struct LogCeresOptions {
  int threads = 2;
  int max_iterations = 10;
};

struct LogCeresSummary {
  int iterations = 0;
  double cost_before = 0.0, cost_after = 0.0;
  int parameters = 0, residuals = 0;
  std::string message;  // why it ended
};

// Computes the corrections that lead from the graph's estimates to the minimum at its present
// factors, by Levenberg-Marquardt with a sparse Cholesky factorization of the normal equations. It
// fills no covariances. Returns false if there is no usable solution; `summary` says why.
bool solve_by_ceres(const LogGraph& graph, const LogCeresOptions& options,
                    LogCorrections* corrections, LogCeresSummary* summary);

}  // namespace leonav
