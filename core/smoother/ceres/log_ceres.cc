#include "core/smoother/ceres/log_ceres.h"

#include <ceres/ceres.h>

#include <memory>
#include <vector>

#include "core/smoother/ceres/internal/log_costs.h"

namespace leonav {
namespace {

// Gauss-Newton steps, damped only where they do not reduce the cost.
ceres::Solver::Options solver_options(const LogCeresOptions& options) {
  ceres::Solver::Options given;
  given.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  given.num_threads = options.threads;
  given.initial_trust_region_radius = 1e16;
  given.max_trust_region_radius = 1e16;
  given.max_num_iterations = options.max_iterations;
  given.function_tolerance = 1e-7;
  given.gradient_tolerance = 0.0;
  given.parameter_tolerance = 0.0;
  given.logging_type = ceres::SILENT;
  return given;
}

}  // namespace

bool solve_by_ceres(const LogGraph& graph, const LogCeresOptions& options,
                    LogCorrections* corrections, LogCeresSummary* summary) {
  LogUnknowns unknowns;
  if (!unknowns.assign(graph)) {
    summary->message = "the process mixes states that it does not move";
    return false;
  }
  std::vector<std::unique_ptr<LogCost>> costs;
  if (!make_costs(graph, unknowns, &costs)) {
    summary->message = "a factor has no definite covariance";
    return false;
  }
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  std::vector<double*> values;
  for (const auto& cost : costs) {
    values.clear();
    for (const int block : cost->blocks()) values.push_back(unknowns.values(block));
    if (cost->num_residuals() > 0) problem.AddResidualBlock(cost.get(), nullptr, values);
  }
  std::vector<std::unique_ptr<PieceCost>> steps;
  for (std::size_t i = 0; i < graph.pieces().size(); ++i) {
    const AmbiguityPiece& piece = graph.pieces()[i];
    const AmbiguityPiece* before = piece.previous >= 0 ? &graph.piece(piece.previous) : nullptr;
    steps.push_back(std::make_unique<PieceCost>(piece, before));
    values = {unknowns.values(unknowns.block_of_piece(static_cast<int>(i)))};
    if (before != nullptr)
      values.push_back(unknowns.values(unknowns.block_of_piece(piece.previous)));
    problem.AddResidualBlock(steps.back().get(), nullptr, values);
  }
  ceres::Solver::Summary solved;
  ceres::Solve(solver_options(options), &problem, &solved);
  summary->iterations = static_cast<int>(solved.iterations.size());
  summary->cost_before = solved.initial_cost;
  summary->cost_after = solved.final_cost;
  summary->parameters = solved.num_parameters;
  summary->residuals = solved.num_residuals;
  summary->message = solved.message;
  if (!solved.IsSolutionUsable()) return false;
  corrections->core.resize(static_cast<std::size_t>(graph.size()));
  for (int k = 0; k < graph.size(); ++k)
    corrections->core[static_cast<std::size_t>(k)] = unknowns.error(k);
  corrections->pieces.resize(static_cast<Eigen::Index>(graph.pieces().size()));
  for (std::size_t i = 0; i < graph.pieces().size(); ++i)
    corrections->pieces(static_cast<Eigen::Index>(i)) =
        *unknowns.values(unknowns.block_of_piece(static_cast<int>(i)));
  return corrections->pieces.allFinite();
}

}  // namespace leonav
