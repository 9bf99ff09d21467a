#include "core/smoother/batch/batch_smoother.h"

#include <algorithm>
#include <cmath>

#include "core/smoother/batch/internal/log_linear.h"
#include "core/smoother/linearization.h"

namespace leonav {
namespace {

using Eigen::Index;

// As long as weights and attitudes are still the filter's, its factors do.
constexpr int kIterationsBeforeExtension = 2;

// Computes the residuals and, unless they are to be kept, the robust factors at the estimates.
// Returns the cost of the measurements.
double reweigh(const BatchConfig& config, bool keep, LogGraph* graph) {
  double cost = 0.0;
  for (int k = 0; k < graph->size(); ++k) {
    LogKeyframe& keyframe = graph->at(k);
    const AntennaMotion antenna = antenna_of(keyframe, keyframe.state, graph->lever_arm_b());
    for (LogMeasurement& measurement : keyframe.measurements) {
      measurement.residual = linearize(*graph, keyframe, measurement, antenna).residual;
      if (!keep && config.robust.enabled) {
        measurement.factor = igg3_factor(measurement.residual / std::sqrt(measurement.variance),
                                         config.robust.k0, config.robust.k1);
      }
      cost += 0.5 * measurement.factor * measurement.residual * measurement.residual /
              measurement.gain_variance;
    }
  }
  return cost;
}

// Adds the corrections and says how far they have moved positions.
void apply(const LogCorrections& corrections, LogGraph* graph, BatchIteration* iteration) {
  for (int k = 0; k < graph->size(); ++k) {
    LogKeyframe& keyframe = graph->at(k);
    const EkfCorrection error =
        full_error(keyframe.active, EkfCorrection(corrections.core[static_cast<std::size_t>(k)]));
    add(error, keyframe.has_attitude, &keyframe.state);
    const double moved_m = error.head<3>().norm();
    iteration->moved_m = std::max(iteration->moved_m, moved_m);
    iteration->moved_sigmas =
        std::max(iteration->moved_sigmas, moved_m / std::max(keyframe.filter_sigma_m, 1e-6));
  }
  for (std::size_t i = 0; i < graph->pieces().size(); ++i)
    graph->pieces()[i].value_m += corrections.pieces(static_cast<Index>(i));
}

}  // namespace

BatchResult smooth(const BatchConfig& config, const LogSolver& solver, LogProcesses* processes,
                   const std::function<void(int, double)>& progress, LogGraph* graph) {
  BatchResult result;
  result.extension_left_out = processes != nullptr;
  for (int i = 0; i < config.max_iterations; ++i) {
    BatchIteration iteration;
    iteration.cost = reweigh(config, i == 0, graph);
    const auto share = [&](double done) { progress(i, done); };
    result.solved =
        solver ? solver(*graph, &result.last) : solve_chain(*graph, share, &result.last);
    if (!result.solved) return result;
    apply(result.last, graph, &iteration);
    // Not behind the last one: the covariances are those of the states that it had.
    if (i + 1 == config.max_iterations && !solver) processes = nullptr;
    if (processes != nullptr && i + 1 == kIterationsBeforeExtension) {
      result.extension = processes->extend(graph);
      result.extension_left_out = false;
    } else if (processes != nullptr) {
      iteration.reintegrated = processes->reintegrate(graph);
    }
    result.iterations.push_back(iteration);
    result.converged =
        i >= kIterationsBeforeExtension && iteration.moved_sigmas < config.converged_sigmas;
    if (result.converged) break;
  }
  if (solver) {
    const auto share = [&](double done) {
      progress(static_cast<int>(result.iterations.size()), done);
    };
    result.solved = solve_chain(*graph, share, &result.last);
    BatchIteration beyond;
    if (result.solved) apply(result.last, graph, &beyond);
  }
  return result;
}

}  // namespace leonav
