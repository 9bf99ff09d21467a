#include "tools/smooth/trajectory.h"

#include <cmath>
#include <vector>

#include "core/filter/update/measurement_model.h"
#include "core/inertial/strapdown/mechanization.h"
#include "core/navigator/interface/solution_conversion.h"

namespace leonav {
namespace {

using Eigen::Index;

constexpr double kAlike_s = 1e-6;  // the last sample of a complete block ends at the keyframe

PvaCovariance pva_of(const ActiveStates& active, const Eigen::MatrixXd& covariance) {
  PvaCovariance pva = PvaCovariance::Zero();
  for (Index i = 0; i < active.core_size(); ++i) {
    for (Index j = 0; j < active.core_size(); ++j) {
      const int row = active.core[static_cast<std::size_t>(i)];
      const int column = active.core[static_cast<std::size_t>(j)];
      if (row < pva.rows() && column < pva.cols()) pva(row, column) = covariance(i, j);
    }
  }
  return pva;
}

// `keyframe` tells of attitude and source.
Solution solution_of(const LogKeyframe& keyframe, const CoreState& state,
                     const PvaCovariance& covariance) {
  Solution solution;
  const double offset_s = keyframe.has_attitude ? time_offset_of(state.vehicle) : 0.0;
  fill_solution(at_stamp(state.nav, offset_s), covariance, keyframe.has_attitude, &solution);
  solution.errors = state.nav.errors;
  solution.source = keyframe.has_gnss ? Source::kSmoother : Source::kInsOnly;
  solution.anchor_epoch = keyframe.index;
  return solution;
}

// The states after every sample of the keyframe's block, from `start` on.
std::vector<NavState> integrated(const LogKeyframe& keyframe, const NavState& start) {
  std::vector<NavState> states;
  Mechanization mechanization;
  mechanization.reset(start, keyframe.sample_before_block);
  for (const ImuSample& sample : keyframe.block) {
    if (sample.interval_ns <= 0 || sample.time <= mechanization.state().time) continue;
    if (sample.start() > mechanization.state().time) break;  // samples are missing
    const bool cut = sample.start() < mechanization.state().time;
    mechanization.advance(cut ? split(sample, mechanization.state().time).after : sample);
    states.push_back(mechanization.state());
  }
  return states;
}

}  // namespace

CoreState Trajectory::state(int k) const {
  const LogKeyframe& keyframe = graph_.at(k);
  CoreState state = keyframe.state;
  if (estimate_ == Estimate::kSmoothed) return state;
  const auto i = static_cast<std::size_t>(k);
  const EkfCorrection back = result_.last.filtered_core[i] - result_.last.core[i];
  add(full_error(keyframe.active, back), keyframe.has_attitude, &state);
  return state;
}

PvaCovariance Trajectory::covariance(int k) const {
  const auto i = static_cast<std::size_t>(k);
  const bool smoothed = estimate_ == Estimate::kSmoothed;
  return pva_of(graph_.at(k).active,
                smoothed ? result_.last.covariance[i] : result_.last.filtered_covariance[i]);
}

Solution Trajectory::at(int k) const { return solution_of(graph_.at(k), state(k), covariance(k)); }

void Trajectory::for_each_sample_before(int k,
                                        const std::function<void(const Solution&)>& use) const {
  const LogKeyframe& before = graph_.at(k - 1);
  const LogKeyframe& keyframe = graph_.at(k);
  const CoreState start = state(k - 1), end = state(k);
  const std::vector<NavState> states = integrated(keyframe, start.nav);
  if (states.empty() || std::abs(seconds_between(states.back().time, keyframe.time)) > kAlike_s)
    return;
  CoreState last = end;
  last.nav = states.back();
  const EkfCorrection missed = difference(end, last);
  const PvaCovariance first_covariance = covariance(k - 1), last_covariance = covariance(k);
  const double interval_s = seconds_between(keyframe.time, before.time);
  for (std::size_t i = 0; i + 1 < states.size(); ++i) {
    const double share = seconds_between(states[i].time, before.time) / interval_s;
    CoreState between = end;
    between.nav = states[i];
    EkfCorrection error = share * missed;
    error.segment<ekf_index::kSize - ekf_index::kGyroBias>(ekf_index::kGyroBias).setZero();
    add(error, true, &between);
    use(solution_of(keyframe, between, (1.0 - share) * first_covariance + share * last_covariance));
  }
}

void Trajectory::for_each_sample(const std::function<void(const Solution&)>& use) const {
  for (int k = 0; k < graph_.size(); ++k) {
    const LogKeyframe& keyframe = graph_.at(k);
    if (k > 0 && keyframe.process.exists && keyframe.has_attitude &&
        graph_.at(k - 1).has_attitude && keyframe.block_complete)
      for_each_sample_before(k, use);
    use(at(k));
  }
}

}  // namespace leonav
