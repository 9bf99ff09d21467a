#include "core/smoother/ceres/ceres_solver.h"

#include <ceres/ceres.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "core/smoother/ceres/internal/window_costs.h"

namespace leonav {
namespace {

constexpr int kLastSteps = 3;

// Gauss-Newton steps, damped only where they do not reduce the cost.
ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.jacobi_scaling = true;
  options.initial_trust_region_radius = 1e16;
  options.max_trust_region_radius = 1e16;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-6;  // smaller changes are rounding

  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 0.0;
  options.logging_type = ceres::SILENT;
  return options;
}

// Takes one more Gauss-Newton step without testing the cost. Ranges are known to 4e-9 m, a
// millionth of a carrier's sigma, and in the sum of squares steps of a thousandth of a sigma are
// lost in rounding.
bool take_last_step(WindowUnknowns* unknowns, ceres::Problem* problem) {
  ceres::Problem::EvaluateOptions order;
  order.parameter_blocks = unknowns->all_values();
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
  const Eigen::VectorXd gradient = J.transpose() * residuals;
  unknowns->add(-scale.cwiseProduct(root.solve(gradient)));
  return true;
}

}  // namespace

bool CeresSolver::solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
                        WindowCorrections* corrections) {
  iterations_ = 0;
  WindowUnknowns unknowns;
  if (!unknowns.assign_blocks(window)) return false;

  std::vector<std::unique_ptr<WindowCost>> costs;
  costs.push_back(std::make_unique<PriorCost>(window, unknowns));
  for (int k = 0; k < window.size(); ++k) {
    if (k > 0) costs.push_back(std::make_unique<ProcessCost>(window, unknowns, k));
    if (k > 0 && window.at(k).process_factor.has_information)
      costs.push_back(std::make_unique<InformationCost>(window, unknowns, k));
    costs.push_back(std::make_unique<MeasurementsCost>(window, unknowns, k, lever_arm_b));
  }
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (const auto& cost : costs) {
    if (!cost->usable()) return false;
    if (cost->num_residuals() > 0)
      problem.AddResidualBlock(cost.get(), nullptr, unknowns.values_of(cost->blocks()));
  }

  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(), &problem, &summary);
  iterations_ = static_cast<int>(summary.iterations.size());
  if (!summary.IsSolutionUsable()) return false;
  for (int i = 0; i < kLastSteps; ++i)
    if (!take_last_step(&unknowns, &problem)) return false;
  corrections->resize(static_cast<std::size_t>(window.size()));
  for (int k = 0; k < window.size(); ++k) {
    EkfCorrection& correction = (*corrections)[static_cast<std::size_t>(k)];
    correction = unknowns.error(k);
    if (!correction.allFinite()) return false;
  }
  return true;
}

}  // namespace leonav
