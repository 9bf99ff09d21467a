#include "tools/bench/solver_comparison.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/smoother/ceres/ceres_solver.h"
#include "core/smoother/rts_solver.h"
#include "daemon/messages/input_dispatch.h"
#include "drivers/lcm/event_log.h"
#include "tools/bench/process_measures.h"
#include "tools/bench/solver_agreement.h"
#include "tools/bench/stopwatch.h"
#include "tools/bench/timed_stages.h"

namespace leonav {
namespace {

constexpr int kTimedApart = 10;  // solves from one timed window to the next, at least

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
      : lever_arm_b_(config.vehicle.lever_arm_b),
        agreement_(lever_arm_b_, window),
        chain_(window) {}

  // `index` counts the solves of the smoother.
  void add(const Window& window, long index) {
    if (window.size() < 2 || !agreement_.add(window)) return;
    satellites_.push_back(satellites(window.newest()));
    if (agreement_.counts().windows > 1 && index < timed_ + kTimedApart) return;
    timed_ = index;
    time_steps(window);
  }

  void print() const {
    std::vector<double> satellites = satellites_;
    std::sort(satellites.begin(), satellites.end());
    const SolverAgreement::Counts& counts = agreement_.counts();
    std::printf("windows: %ld, with noise that Ceres is not given: %ld; satellites: median %.0f\n",
                counts.windows, counts.not_given,
                satellites.empty() ? 0 : quantile_below(satellites, 0.5));
    agreement_.print();
    const double chain_ms = print_times("chain, one step", chain_times_, 0.0);
    for (std::size_t i = 0; i < kLinearSolvers.size(); ++i)
      print_times(kLinearSolvers[i].name, ceres_times_[i], chain_ms);
  }

  void require() const { agreement_.require(); }

 private:
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
  SolverAgreement agreement_;
  RtsSolver chain_;
  WindowCorrections corrections_;
  long timed_ = 0;
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
