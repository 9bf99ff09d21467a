#include "tools/bench/solver_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/smoother/ceres/ceres_solver.h"
#include "core/smoother/ceres/window_graph.h"
#include "core/smoother/rts_solver.h"
#include "daemon/messages/input_dispatch.h"
#include "drivers/lcm/event_log.h"
#include "tools/bench/process_measures.h"
#include "tools/bench/stopwatch.h"
#include "tools/bench/timed_stages.h"

namespace leonav {
namespace {

using Eigen::Index;

constexpr int kSteps = 8;  // of Gauss and Newton, far more than it takes
constexpr double kMostCost = 1e-9, kMostSigmas = 1e-6;
constexpr double kRangeRounding_m = 4e-9;  // of 2e7 m in a double
constexpr int kTimedApart = 10;            // solves from one timed window to the next, at least

struct LinearSolver {
  const char* name;
  LogCeresLinear linear;
  LogCeresLibrary library;
};
constexpr std::array<LinearSolver, 5> kLinearSolvers = {
    {{"Ceres, sparse normal equations", LogCeresLinear::kSparseNormal, LogCeresLibrary::kDefault},
     {"Ceres, sparse Schur", LogCeresLinear::kSparseSchur, LogCeresLibrary::kDefault},
     {"Ceres, CXSparse, normal equations", LogCeresLinear::kSparseNormal,
      LogCeresLibrary::kCxSparse},
     {"Ceres, CXSparse, Schur", LogCeresLinear::kSparseSchur, LogCeresLibrary::kCxSparse},
     {"Ceres, dense Schur", LogCeresLinear::kDenseSchur, LogCeresLibrary::kDefault}}};

void apply(const WindowCorrections& corrections, Window* window) {
  for (int i = 0; i < window->size(); ++i) {
    Keyframe& keyframe = window->at(i);
    add(full_error(keyframe.active, corrections[static_cast<std::size_t>(i)]),
        keyframe.has_attitude, &keyframe.state);
  }
}

// Displaces every estimate by a sigma of the newest keyframe, to and fro.
void displace(const EkfCorrection& sigmas, Window* window) {
  for (int i = 0; i < window->size(); ++i) {
    Keyframe& keyframe = window->at(i);
    EkfCorrection error = EkfCorrection::Zero(keyframe.active.size());
    const Index core = std::min(keyframe.active.core_size(), sigmas.size());
    for (Index j = 0; j < core; ++j) error(j) = ((i + j) % 2 == 0 ? 1.0 : -1.0) * sigmas(j);
    add(full_error(keyframe.active, error), keyframe.has_attitude, &keyframe.state);
  }
}

// The least sigma of a carrier with weight in the window, m.
double least_carrier_sigma(const Window& window) {
  double least = 1.0;
  for (int i = 0; i < window.size(); ++i)
    for (const KeyframeMeasurement& m : window.at(i).measurements)
      if (m.measurement.observable == Observable::kCarrier && m.factor > 0.0)
        least = std::min(least, std::sqrt(m.gain_variance));
  return least;
}

// Returns how many satellites have weight in a keyframe.
double satellites(const Keyframe& keyframe) {
  std::array<bool, kMaxSatellites> used{};
  for (const KeyframeMeasurement& m : keyframe.measurements)
    if (m.factor > 0.0) used[m.measurement.satellite_index] = true;
  return static_cast<double>(std::count(used.begin(), used.end(), true));
}

class Comparison {
 public:
  Comparison(const NavigatorConfig& config, int window)
      : lever_arm_b_(config.vehicle.lever_arm_b), chain_(window), ceres_(precise()) {}

  // `index` counts the solves of the smoother.
  void add(const Window& window, long index) {
    if (window.size() < 2) return;
    Window by_chain(window), by_ceres(window);
    EkfCovariance covariance;
    if (!chain_.solve(window, lever_arm_b_, &corrections_)) return;
    chain_.newest_covariance(&covariance);
    const EkfCorrection sigmas = covariance.diagonal().cwiseSqrt();
    displace(sigmas.head(window.newest().active.core_size()), &by_chain);
    displace(sigmas.head(window.newest().active.core_size()), &by_ceres);
    if (!graph_of(window, lever_arm_b_)) {
      ++not_given_;
      return;
    }
    ++windows_;
    satellites_.push_back(satellites(window.newest()));
    const bool chain = iterate(&by_chain);
    const bool ceres = ceres_.solve(by_ceres, lever_arm_b_, &corrections_);
    if (ceres) apply(corrections_, &by_ceres);
    if (chain != ceres) ++(chain ? only_chain_ : only_ceres_);
    if (!chain || !ceres) return;
    const double cost = cost_of(by_chain), other = cost_of(by_ceres);
    const double rounding = kRangeRounding_m / least_carrier_sigma(window);
    const double cost_apart = std::abs(cost - other) / std::max(cost, 1.0);
    // The roundings of residuals add up as the root of their squares.
    const double cost_allowed =
        std::max(kMostCost, 3.0 * rounding * std::sqrt(2.0 / std::max(cost, 1.0)));
    most_cost_ = std::max(most_cost_, cost_apart);
    most_of_allowed_ = std::max(most_of_allowed_, cost_apart / cost_allowed);
    const EkfCorrection apart = active_part(
        by_chain.newest().active, difference(by_chain.newest().state, by_ceres.newest().state));
    const double allowed = std::max(kMostSigmas, 3.0 * rounding);
    const double sigmas_apart = apart.cwiseQuotient(sigmas).cwiseAbs().maxCoeff();
    most_sigmas_ = std::max(most_sigmas_, sigmas_apart);
    most_of_allowed_ = std::max(most_of_allowed_, sigmas_apart / allowed);
    if (windows_ > 1 && index < timed_ + kTimedApart) return;
    timed_ = index;
    time_steps(window);
  }

  void print() const {
    std::vector<double> satellites = satellites_;
    std::sort(satellites.begin(), satellites.end());
    std::printf("windows: %ld, with noise that Ceres is not given: %ld; satellites: median %.0f\n",
                windows_, not_given_, satellites.empty() ? 0 : quantile_below(satellites, 0.5));
    std::printf("minimum found by the chain alone: %ld, by Ceres alone: %ld\n", only_chain_,
                only_ceres_);
    std::printf("largest difference of cost: %.2e of it; of the newest states: %.2e sigma\n",
                most_cost_, most_sigmas_);
    std::printf("largest share of what rounding allows: %.2f\n", most_of_allowed_);
    const double chain_ms = print_times("chain, one step", chain_times_, 0.0);
    for (std::size_t i = 0; i < kLinearSolvers.size(); ++i)
      print_times(kLinearSolvers[i].name, ceres_times_[i], chain_ms);
  }

  void require() const {
    if (windows_ == 0) throw std::runtime_error("the log gave the smoother no window");
    if (only_chain_ + only_ceres_ > 0)
      throw std::runtime_error("one solver has found a minimum where the other has not");
    if (!(most_of_allowed_ < 1.0)) throw std::runtime_error("the solvers differ");
  }

 private:
  static LogCeresOptions precise() {
    LogCeresOptions options;
    options.threads = 1;
    options.max_iterations = 50;
    options.last_steps = 3;
    return options;
  }

  bool iterate(Window* window) {
    for (int i = 0; i < kSteps; ++i) {
      if (!chain_.solve(*window, lever_arm_b_, &corrections_)) return false;
      apply(corrections_, window);
    }
    return is_finite(window->newest().state);
  }

  double cost_of(const Window& window) const {
    LogCeresOptions none;
    none.max_iterations = 0;
    LogCorrections unused;
    LogCeresSummary summary;
    solve_by_ceres(graph_of(window, lever_arm_b_)->graph, none, &unused, &summary);
    return summary.cost_before;
  }

  void time_steps(const Window& window) {
    const Stopwatch watch;
    chain_.solve(window, lever_arm_b_, &corrections_);
    watch.stop(&chain_times_);
    for (std::size_t i = 0; i < kLinearSolvers.size(); ++i) {
      if (!has_library(kLinearSolvers[i].library)) continue;
      LogCeresOptions one;
      one.library = kLinearSolvers[i].library;
      one.threads = 1;
      one.max_iterations = 1;
      one.linear = kLinearSolvers[i].linear;
      CeresSolver solver(one);
      const Stopwatch ceres_watch;
      solver.solve(window, lever_arm_b_, &corrections_);
      ceres_watch.stop(&ceres_times_[i]);
    }
  }

  // Returns the median, ms; `chain_ms`: the chain's, or 0.
  static double print_times(const char* name, const Times& times, double chain_ms) {
    std::vector<double> ms = times.processor_s;
    if (ms.empty()) return 0.0;
    for (double& value : ms) value *= 1e3;
    std::sort(ms.begin(), ms.end());
    const double median = quantile_below(ms, 0.5), slow = quantile_below(ms, 0.999);
    std::printf("%-32s median %8.3f ms  99.9 %% %8.3f ms  (%.2f of the median)", name, median, slow,
                slow / median);
    if (chain_ms > 0.0) std::printf("  %.1f times the chain's", median / chain_ms);
    std::printf("\n");
    return median;
  }

  Eigen::Vector3d lever_arm_b_;
  RtsSolver chain_;
  CeresSolver ceres_;
  WindowCorrections corrections_;
  long timed_ = 0, windows_ = 0, not_given_ = 0, only_chain_ = 0, only_ceres_ = 0;
  double most_cost_ = 0.0, most_sigmas_ = 0.0, most_of_allowed_ = 0.0;
  std::vector<double> satellites_;
  Times chain_times_;
  std::array<Times, kLinearSolvers.size()> ceres_times_;
};

}  // namespace

void compare_solvers(const NavigatorConfig& config, const std::string& log_path,
                     const std::string& prefix, int every) {
  if (config.estimator != Estimator::kSmoother)
    throw std::runtime_error("the solvers are the smoother's: give --set estimator=smoother");
  TimedStages stages(config);
  InputDispatch dispatch(stages.sequencer());
  const auto comparison = std::make_unique<Comparison>(config, config.smoother.window);
  EventLogReader reader(log_path);
  LogEvent event;
  std::size_t solves = 0;
  while (reader.next(&event)) {
    const auto channel = channel_from_name(event.channel, prefix);
    if (!channel || !is_input(*channel)) continue;
    dispatch.dispatch(*channel, event.data);
    if (stages.solve.wall_s.size() == solves) continue;
    solves = stages.solve.wall_s.size();
    if (solves % static_cast<std::size_t>(every) == 0)
      comparison->add(*stages.window(), static_cast<long>(solves));
  }
  comparison->print();
  comparison->require();
}

}  // namespace leonav
