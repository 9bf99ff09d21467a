#include "core/smoother/ceres/log_ceres.h"

#include <ceres/ceres.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/smoother/ceres/internal/log_costs.h"

namespace leonav {
namespace {

ceres::LinearSolverType type_of(LogCeresLinear linear) {
  switch (linear) {
    case LogCeresLinear::kSparseSchur:
      return ceres::SPARSE_SCHUR;
    case LogCeresLinear::kDenseSchur:
      return ceres::DENSE_SCHUR;
    case LogCeresLinear::kSparseNormal:
      break;
  }
  return ceres::SPARSE_NORMAL_CHOLESKY;
}

// By its name, because a Ceres without CXSparse may not have the constant either.
bool find_cx_sparse(ceres::SparseLinearAlgebraLibraryType* type) {
  return ceres::StringToSparseLinearAlgebraLibraryType("CX_SPARSE", type);
}

// Gauss-Newton steps, damped only where they do not reduce the cost.
ceres::Solver::Options solver_options(const LogCeresOptions& options) {
  ceres::Solver::Options given;
  given.linear_solver_type = type_of(options.linear);
  given.num_threads = options.threads;
  given.initial_trust_region_radius = 1e16;
  given.max_trust_region_radius = 1e16;
  given.max_num_iterations = options.max_iterations;
  given.function_tolerance = 1e-7;
  given.gradient_tolerance = 0.0;
  given.parameter_tolerance = 0.0;
  given.logging_type = ceres::SILENT;
  if (options.library == LogCeresLibrary::kEigen) {
    given.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    given.dense_linear_algebra_library_type = ceres::EIGEN;
  } else if (options.library == LogCeresLibrary::kCxSparse) {
    find_cx_sparse(&given.sparse_linear_algebra_library_type);
  }
  return given;
}

// Ends the solve where somebody says so.
class Limit final : public ceres::IterationCallback {
 public:
  explicit Limit(const std::function<bool(int)>& may_iterate) : may_iterate_(may_iterate) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (summary.iteration == 0 || may_iterate_(summary.iteration)) return ceres::SOLVER_CONTINUE;
    return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }

 private:
  const std::function<bool(int)>& may_iterate_;
};

std::unique_ptr<ceres::LossFunction> loss_of(const LogCeresOptions& options, const LogCost& cost) {
  const double ratio = cost.gain_to_test_sigma();
  if (!(ratio > 0.0) || options.loss == CeresLoss::kIgg3) return nullptr;
  const double scale = options.loss_sigmas / ratio;
  if (options.loss == CeresLoss::kHuber) return std::make_unique<ceres::HuberLoss>(scale);
  return std::make_unique<ceres::CauchyLoss>(scale);
}

// Returns whether the estimate is the minimum, or nearer to it than it was.
bool has_moved(const ceres::Solver::Summary& solved) {
  if (solved.termination_type == ceres::CONVERGENCE) return true;
  return solved.IsSolutionUsable() &&
         std::any_of(solved.iterations.begin(), solved.iterations.end(),
                     [](const ceres::IterationSummary& step) {
                       return step.iteration > 0 && step.step_is_successful;
                     });
}

bool take_last_step(LogUnknowns* unknowns, ceres::Problem* problem) {
  ceres::Problem::EvaluateOptions order;
  for (int block = 0; block < unknowns->blocks(); ++block)
    if (problem->HasParameterBlock(unknowns->values(block)))
      order.parameter_blocks.push_back(unknowns->values(block));
  std::vector<double> values;
  ceres::CRSMatrix rows;
  if (!problem->Evaluate(order, nullptr, &values, nullptr, &rows)) return false;
  Eigen::SparseMatrix<double> J = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(),
      rows.cols.data(), rows.values.data());
  Eigen::VectorXd scale(J.cols());
  for (Eigen::Index i = 0; i < J.cols(); ++i) scale(i) = 1.0 / J.col(i).norm();
  J = J * scale.asDiagonal();
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> root(J.transpose() * J);
  if (root.info() != Eigen::Success) return false;
  const Eigen::Map<const Eigen::VectorXd> residuals(values.data(), rows.num_rows);
  const Eigen::VectorXd change =
      -scale.cwiseProduct(root.solve(Eigen::VectorXd(J.transpose() * residuals)));
  Eigen::Index i = 0;
  for (double* block : order.parameter_blocks)
    for (int k = 0; k < problem->ParameterBlockSize(block); ++k) block[k] += change(i++);
  return change.allFinite();
}

}  // namespace

bool has_library(LogCeresLibrary library) {
  if (library == LogCeresLibrary::kDefault) return true;
  ceres::SparseLinearAlgebraLibraryType type = ceres::EIGEN_SPARSE;
  if (library == LogCeresLibrary::kCxSparse && !find_cx_sparse(&type)) return false;
  return ceres::IsSparseLinearAlgebraLibraryTypeAvailable(type);
}

bool solve_by_ceres(const LogGraph& graph, const LogCeresOptions& options,
                    LogCorrections* corrections, LogCeresSummary* summary) {
  LogUnknowns unknowns;
  if (!unknowns.assign(graph)) {
    summary->message = "the process mixes states that it does not move";
    return false;
  }
  std::vector<std::unique_ptr<LogCost>> costs;
  if (!make_costs(graph, unknowns, options.loss == CeresLoss::kIgg3, &costs)) {
    summary->message = "a factor has no definite covariance";
    return false;
  }
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.disable_all_safety_checks = true;
  std::vector<std::unique_ptr<ceres::LossFunction>> losses;
  ceres::Problem problem(ownership);
  std::vector<double*> values;
  for (const auto& cost : costs) {
    values.clear();
    for (const int block : cost->blocks()) values.push_back(unknowns.values(block));
    losses.push_back(loss_of(options, *cost));
    if (cost->num_residuals() > 0)
      problem.AddResidualBlock(cost.get(), losses.back().get(), values);
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
  ceres::Solver::Options solver = solver_options(options);
  Limit limit(options.may_iterate);
  if (options.may_iterate) solver.callbacks.push_back(&limit);
  ceres::Solve(solver, &problem, &solved);
  const bool failed = solved.termination_type == ceres::FAILURE;
  summary->iterations = static_cast<int>(solved.iterations.size()) - 1 + (failed ? 1 : 0);
  summary->cost_before = solved.initial_cost;
  summary->cost_after = solved.final_cost;
  summary->parameters = solved.num_parameters;
  summary->residuals = solved.num_residuals;
  summary->message = solved.message;
  if (!has_moved(solved)) return false;
  for (int i = 0; i < options.last_steps; ++i)
    if (!take_last_step(&unknowns, &problem)) return false;
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
