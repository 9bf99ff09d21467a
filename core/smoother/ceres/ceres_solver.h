// CeresSolver minimizes the window's cost by Ceres (http://ceres-solver.org).
#pragma once
#include "core/smoother/ceres/log_ceres.h"
#include "core/smoother/window_solver.h"

namespace leonav {

// Levenberg-Marquardt on the whole window, in other unknowns than those of RtsSolver: a state that
// the process does not change is one unknown for all its keyframes. It allocates.
class CeresSolver final : public WindowSolver {
 public:
  explicit CeresSolver(const LogCeresOptions& options = {}) : options_(options) {}

  // Computes corrections that lead to the minimum, as far as the iterations reach. Returns false
  // also for a window that a LogGraph cannot hold (window_graph.h); summary() says why.
  bool solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
             WindowCorrections* corrections) override;

  void limit(SolveBudget* budget) override { budget_ = budget; }
  int iterations() const override { return summary_.iterations; }

  // Of the last solve().
  const LogCeresSummary& summary() const { return summary_; }

 private:
  LogCeresOptions options_;
  SolveBudget* budget_ = nullptr;
  LogCeresSummary summary_;
};

}  // namespace leonav
