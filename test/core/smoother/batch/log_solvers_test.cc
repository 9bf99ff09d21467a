// Both solvers of a whole log, the chain and Ceres, lead to the same minimum.
#include <memory>

#include "core/smoother/batch/batch_smoother.h"
#include "core/smoother/ceres/log_ceres.h"
#include "core/smoother/drive_rig.h"
#include "drive_graph.h"
#include "support/catch.h"

namespace leonav {
namespace {

using namespace synthetic;

// The largest distance of two core estimates in sigmas.
double apart(const LogGraph& a, const LogGraph& b, const LogCorrections& covariances) {
  double most = 0.0;
  for (int k = 0; k < a.size(); ++k) {
    const EkfCorrection error =
        active_part(a.at(k).active, difference(a.at(k).state, b.at(k).state));
    const Eigen::VectorXd variances =
        covariances.covariance[static_cast<std::size_t>(k)].diagonal();
    for (Eigen::Index i = 0; i < error.size(); ++i)
      most = std::max(most, std::abs(error(i)) / std::sqrt(variances(i)));
  }
  return most;
}

BatchResult smooth_log(const LogSolver& solver, LogGraph* graph) {
  BatchConfig config;
  config.robust.enabled = false;
  config.converged_sigmas = 1e-6;
  return smooth(
      config, solver, nullptr, [](int, double) {}, graph);
}

}  // namespace

TEST_CASE("a whole log: the chain leads where Ceres leads") {
  DriveOptions options;
  options.random_walk = GENERATE(0.0, 1e-3, 0.02);
  options.arc_epochs = GENERATE(1'000'000, 15);
  options.constrained = GENERATE(false, true);
  options.joined = GENERATE(false, true);
  LogGraph by_chain = graph_of(options, 40), by_ceres = graph_of(options, 40);
  const BatchResult chain = smooth_log(nullptr, &by_chain);
  const BatchResult ceres = smooth_log(
      [](const LogGraph& graph, LogCorrections* corrections) {
        LogCeresSummary summary;
        return solve_by_ceres(graph, {}, corrections, &summary);
      },
      &by_ceres);
  REQUIRE(chain.converged);
  REQUIRE(ceres.converged);
  CHECK(apart(by_chain, by_ceres, chain.last) < 1e-5);
}

TEST_CASE("the pass of the chain after a solver's iterations has progress too") {
  LogGraph graph = graph_of(DriveOptions{}, 20);
  BatchConfig config;
  config.robust.enabled = false;
  config.max_iterations = 3;
  double last = 0.0;
  const BatchResult result = smooth(
      config,
      [](const LogGraph& given, LogCorrections* corrections) {
        LogCeresSummary summary;
        return solve_by_ceres(given, {}, corrections, &summary);
      },
      nullptr, [&](int iteration, double share) { last = iteration + share; }, &graph);
  REQUIRE(result.solved);
  CHECK(last == Approx(static_cast<double>(result.iterations.size()) + 1.0));
}

}  // namespace leonav
