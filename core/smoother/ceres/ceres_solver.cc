#include "core/smoother/ceres/ceres_solver.h"

#include "core/smoother/ceres/window_graph.h"

namespace leonav {

using Eigen::Index;

bool CeresSolver::solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
                        WindowCorrections* corrections) {
  summary_ = LogCeresSummary();
  const auto given = graph_of(window, lever_arm_b);
  if (!given) {
    summary_.message = "noise that ambiguities share with other states";
    return false;
  }
  LogCeresOptions options = options_;
  if (budget_ != nullptr)
    options.may_iterate = [this](int done) { return budget_->may_iterate(done); };
  LogCorrections whole;
  if (!solve_by_ceres(given->graph, options, &whole, &summary_)) return false;
  corrections->resize(static_cast<std::size_t>(window.size()));
  for (int k = 0; k < window.size(); ++k) {
    const LogKeyframe& keyframe = given->graph.at(k);
    const Ambiguities& ambiguities = window.at(k).state.ambiguities;
    EkfCorrection& correction = (*corrections)[static_cast<std::size_t>(k)];
    correction.resize(keyframe.size());
    correction.head(keyframe.core_size()) = whole.core[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < keyframe.pieces.size(); ++i)
      correction(keyframe.core_size() + static_cast<Index>(i)) =
          whole.pieces(keyframe.pieces[i]) + given->ambiguities_m[static_cast<std::size_t>(k)][i] -
          ambiguities[i].value_m;
    if (!correction.allFinite()) return false;
  }
  return true;
}

}  // namespace leonav
