#include "tools/bench/solver_agreement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "core/smoother/ceres/window_graph.h"

namespace leonav {
namespace {

using Eigen::Index;

constexpr int kSteps = 8;  // of Gauss and Newton, far more than it takes
constexpr double kMostCost = 1e-9, kMostSigmas = 1e-6;
constexpr double kRangeRounding_m = 4e-9;  // of 2e7 m in a double

LogCeresOptions precise() {
  LogCeresOptions options;
  options.threads = 1;
  options.max_iterations = 50;
  options.last_steps = 3;
  return options;
}

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

// The newest keyframe's sigma of active state `i` of `keyframe`; 0: that has no such state.
double newest_sigma(const Keyframe& newest, const EkfCorrection& sigmas, const Keyframe& keyframe,
                    Index i) {
  const Index core = keyframe.active.core_size();
  if (i < core) {
    const auto& states = newest.active.core;
    const auto found =
        std::find(states.begin(), states.end(), keyframe.active.core[static_cast<std::size_t>(i)]);
    return found == states.end() ? 0.0 : sigmas(found - states.begin());
  }
  const Ambiguity& ambiguity = keyframe.state.ambiguities[static_cast<std::size_t>(i - core)];
  for (std::size_t j = 0; j < newest.state.ambiguities.size(); ++j) {
    const Ambiguity& other = newest.state.ambiguities[j];
    if (other.satellite == ambiguity.satellite && other.arc == ambiguity.arc)
      return sigmas(newest.active.core_size() + static_cast<Index>(j));
  }
  return 0.0;
}

}  // namespace

SolverAgreement::SolverAgreement(const Eigen::Vector3d& lever_arm_b, int capacity)
    : lever_arm_b_(lever_arm_b), chain_(capacity), ceres_(precise()) {}

bool SolverAgreement::add(const Window& window) {
  if (!graph_of(window, lever_arm_b_)) {
    ++counts_.not_given;
    return false;
  }
  ++counts_.windows;
  Window by_chain(window), by_ceres(window);
  EkfCorrection sigmas;
  bool chain = chain_.solve(window, lever_arm_b_, &corrections_);
  if (chain) {
    EkfCovariance covariance;
    chain_.newest_covariance(&covariance);
    sigmas = covariance.diagonal().cwiseSqrt();
    const EkfCorrection core = sigmas.head(window.newest().active.core_size());
    displace(core, &by_chain);
    displace(core, &by_ceres);
    chain = iterate(&by_chain);
  }
  const bool ceres = ceres_.solve(by_ceres, lever_arm_b_, &corrections_);
  if (ceres) apply(corrections_, &by_ceres);
  if (chain != ceres) ++(chain ? counts_.only_chain : counts_.only_ceres);
  if (!chain && !ceres) ++counts_.neither;
  if (chain && ceres) compare(by_chain, by_ceres, sigmas);
  return true;
}

void SolverAgreement::compare(const Window& by_chain, const Window& by_ceres,
                              const EkfCorrection& sigmas) {
  const double cost = cost_of(by_chain), other = cost_of(by_ceres);
  const double rounding = kRangeRounding_m / least_carrier_sigma(by_chain);
  const double cost_apart = std::abs(cost - other) / std::max(cost, 1.0);
  // The roundings of residuals add up as the root of their squares.
  const double cost_allowed =
      std::max(kMostCost, 3.0 * rounding * std::sqrt(2.0 / std::max(cost, 1.0)));
  double sigmas_apart = 0.0;
  for (int k = 0; k < by_chain.size(); ++k) {
    const Keyframe& keyframe = by_chain.at(k);
    const EkfCorrection apart =
        active_part(keyframe.active, difference(keyframe.state, by_ceres.at(k).state));
    for (Index i = 0; i < apart.size(); ++i) {
      const double sigma = newest_sigma(by_chain.newest(), sigmas, keyframe, i);
      if (sigma > 0.0) sigmas_apart = std::max(sigmas_apart, std::abs(apart(i)) / sigma);
    }
  }
  const double sigmas_allowed = std::max(kMostSigmas, 3.0 * rounding);
  counts_.most_cost = std::max(counts_.most_cost, cost_apart);
  counts_.most_sigmas = std::max(counts_.most_sigmas, sigmas_apart);
  counts_.most_of_allowed =
      std::max({counts_.most_of_allowed, cost_apart / cost_allowed, sigmas_apart / sigmas_allowed});
}

bool SolverAgreement::iterate(Window* window) {
  for (int i = 0; i < kSteps; ++i) {
    if (!chain_.solve(*window, lever_arm_b_, &corrections_)) return false;
    apply(corrections_, window);
  }
  return is_finite(window->newest().state);
}

double SolverAgreement::cost_of(const Window& window) const {
  LogCeresOptions none;
  none.max_iterations = 0;
  LogCorrections unused;
  LogCeresSummary summary;
  const auto given = graph_of(window, lever_arm_b_);
  if (given) solve_by_ceres(given->graph, none, &unused, &summary);
  if (!given || summary.residuals == 0 || !std::isfinite(summary.cost_before))
    throw std::runtime_error("the cost of a window that was solved is not known: " +
                             summary.message);
  return summary.cost_before;
}

void SolverAgreement::print() const {
  std::printf("minimum found by the chain alone: %ld, by Ceres alone: %ld, by neither: %ld\n",
              counts_.only_chain, counts_.only_ceres, counts_.neither);
  std::printf("largest difference of cost: %.2e of it; of the states: %.2e sigma\n",
              counts_.most_cost, counts_.most_sigmas);
  std::printf("largest share of what rounding allows: %.2f\n", counts_.most_of_allowed);
}

void SolverAgreement::require() const {
  if (counts_.windows == 0) throw std::runtime_error("the log gave the smoother no window");
  if (counts_.only_chain + counts_.only_ceres > 0)
    throw std::runtime_error("one solver has found a minimum where the other has not");
  if (!(counts_.most_of_allowed < 1.0)) throw std::runtime_error("the solvers differ");
}

}  // namespace leonav
