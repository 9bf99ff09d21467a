// This unit minimizes the cost of a whole log by Ceres (http://ceres-solver.org).
#pragma once
#include <functional>
#include <string>

#include "core/smoother/batch/log_chain.h"
#include "core/smoother/batch/log_graph.h"
#include "core/smoother/smoother_config.h"

namespace leonav {

// Ceres's way to solve the linear equations of a step, all by direct factorization.
enum class LogCeresLinear {
  kSparseNormal,  // sparse Cholesky of the normal equations
  kSparseSchur,   // the same after independent blocks are eliminated
  kDenseSchur     // dense Cholesky after that
};

// The library that factorizes sparse matrices for Ceres.
enum class LogCeresLibrary {
  kDefault,   // Ceres's choice: SuiteSparse where it was built with it
  kCxSparse,  // not in every Ceres
  kEigen      // for dense matrices too: the result does not depend on the machine's libraries
};
bool has_library(LogCeresLibrary library);

struct LogCeresOptions {
  int threads = 2;
  int max_iterations = 10;
  LogCeresLinear linear = LogCeresLinear::kSparseNormal;
  CeresLoss loss = CeresLoss::kIgg3;  // otherwise all factors count as one
  double loss_sigmas = 1.5;           // from which on a residual weighs less
  LogCeresLibrary library = LogCeresLibrary::kDefault;
  // Steps of Gauss and Newton beyond, without a test of the cost. Ranges are known to 4e-9 m, a
  // millionth of a carrier's sigma, and in the sum of squares steps of a thousandth of a sigma are
  // lost in rounding.
  int last_steps = 0;
  // Is asked before every iteration but the first, with those done; empty: nobody is.
  std::function<bool(int)> may_iterate;
};

struct LogCeresSummary {
  int iterations = 0;  // steps tried, a last one that failed included
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
