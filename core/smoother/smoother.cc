#include "core/smoother/smoother.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/smoother/linearization.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Index;

constexpr std::size_t kEnoughSatellites = 4;
// A filter that has started over has caught up once its sigma is so many times the window's.
constexpr double kAsCertain = 1.1;
constexpr double kLongestYounger_s = 180.0;  // after that it counts as of the window's age anyway
// A filter that has started over stays on its own so long, and until so many solves in a row had at
// least so many codes of which most fit the window.
constexpr double kOnItsOwn_s = 10.0;
constexpr int kFittingSolves = 8, kFittingCodes = 4;
// When a filter has aligned again, the window ends if its attitude differs from the filter's by
// more than so many sigmas of the filter's (three axes together).
constexpr double kAttitudeContradiction = 5.0;
// Weights stay unchanged if the position's sigma exceeds this: a reflected code does not stand out
// then, and a few satellites would outvote the others.
constexpr double kVague_m = 5.0;
// Process factors that are repropagated after one solve: a new heading moves all attitudes of the
// window at once.
constexpr int kMostRepropagations = 2;
constexpr double kDrilledError_m = 1e5;

double position_sigma(const EkfCovariance& covariance) {
  return std::sqrt(std::max(0.0, covariance.topLeftCorner<3, 3>().trace()));
}

// Returns whether the filter's new attitude contradicts the window's.
bool contradicts_attitude(const Keyframe& keyframe, const KeyframeInput& input) {
  const double variance = input.covariance.block<3, 3>(kAttitude, kAttitude).trace();
  const double apart = keyframe.state.nav.q_eb.angularDistance(input.state.nav.q_eb);
  return apart > kAttitudeContradiction * std::sqrt(std::max(0.0, variance));
}

// Returns whether the window has measurements of enough satellites to determine a position.
bool has_enough_satellites(const Window& window) {
  boost::container::static_vector<SatelliteId, kEnoughSatellites> seen;
  for (int i = window.size() - 1; i >= 0; --i) {
    const Keyframe& keyframe = window.at(i);
    for (const KeyframeMeasurement& measurement : keyframe.measurements) {
      const SatelliteId satellite =
          keyframe.satellites[measurement.measurement.satellite_index].satellite;
      if (!(measurement.factor > 0.0) ||
          std::find(seen.begin(), seen.end(), satellite) != seen.end())
        continue;
      seen.push_back(satellite);
      if (seen.size() == kEnoughSatellites) return true;
    }
  }
  return false;
}

}  // namespace

Smoother::Smoother(const SmootherConfig& config, const RobustConfig& robust,
                   const Eigen::Vector3d& lever_arm_b,
                   const ProcessPropagationConfig& repropagation,
                   std::unique_ptr<WindowSolver> minimizer)
    : config_(config),
      robust_(robust),
      lever_arm_b_(lever_arm_b),
      window_(config.window),
      weights_(robust, config.reweigh_s, config.code_alike_s),
      rts_solver_(window_.capacity()),
      minimizer_(std::move(minimizer)),
      repropagator_(repropagation),
      step_(window_.capacity()),
      saved_(std::make_unique<Saved[]>(static_cast<std::size_t>(window_.capacity()))),
      next_prior_(std::make_unique<WindowPrior>()) {}

void Smoother::add(const KeyframeInput& input) {
  if (solved_) commit_or_roll_back(false);
  if (!input.valid) return window_.clear();
  filter_has_attitude_ = input.has_attitude;
  filter_position_e_ = input.state.nav.p_e;
  if (!input.has_attitude) filter_position_e_ += input.vertical_antenna_offset_e;
  filter_sigma_m_ = position_sigma(input.covariance);
  const bool filter_goes_on = input.follows_previous && has_all_of_window(input);
  if (failed_ || !(filter_goes_on || can_bridge(window_, input))) window_.clear();
  failed_ = false;
  const bool follows = window_.size() > 0;
  if (window_.full()) marginalize_and_drop_oldest();
  newest_follows_ = window_.size() > 0 && append(input);
  window_lost_ = follows && !newest_follows_;
  if (!newest_follows_) {
    window_sigma_m_ = std::numeric_limits<double>::infinity();
    believed_.reset();
    fitting_ = 0;
    restarted_ = GpsTime();
    return (void)window_.start(input);
  }
  if (config_.window > 1) return;
  marginalize_and_drop_oldest();  // a window of one keyframe has all earlier ones in its prior
  newest_follows_ = window_.size() > 0;
  window_lost_ = !newest_follows_;
}

// Returns whether the filter has an attitude where the window has one.
bool Smoother::has_all_of_window(const KeyframeInput& input) const {
  return input.has_attitude || window_.size() == 0 || !window_.newest().has_attitude;
}

// Appends a keyframe with the window's own inertial process.
bool Smoother::append(const KeyframeInput& input) {
  if (input.follows_previous && has_all_of_window(input)) {
    if (!window_.append(input)) return false;
  } else {
    if (!input.follows_previous && !input.has_attitude) restarted_ = input.time;
    if (!input.follows_previous) fitting_ = 0;
    window_.append_apart(input);
  }
  const Keyframe& before = window_.at(window_.size() - 2);
  Keyframe& newest = window_.newest();
  newest.process_factor.to.random_walk = before.state.random_walk;
  repropagator_.integrate(before, &newest);
  newest.state = predicted_state(before, newest);
  const bool aligned_again = filter_is_younger() && input.has_attitude && !input.follows_previous;
  if (aligned_again && contradicts_attitude(newest, input)) return false;
  if (!input.has_attitude && newest.has_attitude) {
    newest.measured_rate_b = repropagator_.body().measured_rate_b;
    newest.acceleration_e = repropagator_.body().acceleration_e;
  }
  return is_finite(newest.state);
}

void Smoother::marginalize_and_drop_oldest() {
  if (rts_solver_.marginalize_oldest(window_, lever_arm_b_, next_prior_.get()))
    window_.drop_oldest(*next_prior_);
  else
    window_.clear();
}

SmootherResult Smoother::solve(SolveBudget* budget) {
  SmootherResult result;
  if (window_.size() == 0) return result;
  save();
  solved_ = true;
  result.status = newest_follows_ ? SmootherStatus::kOk
                  : window_lost_  ? SmootherStatus::kSingular
                                  : SmootherStatus::kStarted;
  if (fails_on_purpose(DrilledFailure::kSingular))
    window_.newest().state.nav.p_e.setConstant(std::numeric_limits<double>::quiet_NaN());
  if (minimizer_ != nullptr) {
    if (!minimize(budget, &result)) {
      result.status = SmootherStatus::kSingular;
      failed_ = true;
      return result;
    }
    finish(&result);
    return result;
  }
  while (result.iterations < std::max(1, config_.max_iterations)) {
    if (result.iterations > 0 && !budget->may_iterate(result.iterations)) break;
    // The iteration that fails counts: a replay has to make it too.
    if (!iterate(result.iterations++, &result)) {
      result.status = SmootherStatus::kSingular;
      failed_ = true;
      return result;
    }
    if (result.converged) break;
  }
  finish(&result);
  return result;
}

// Depends on the epoch's number alone, so that a replay fails at the same ones.
bool Smoother::fails_on_purpose(DrilledFailure failure) const {
  return config_.drill_failure_every > 0 && config_.drill_failure == failure &&
         window_.newest().index % static_cast<std::uint64_t>(config_.drill_failure_every) == 0;
}

// Does one iteration: weights and one step, which is short enough or not.
bool Smoother::iterate(int iteration, SmootherResult* result) {
  if (robust_.enabled && config_.reweigh && sigma_m() < kVague_m)
    weights_.update_factors(iteration == 0, lever_arm_b_, &window_);
  if (!rts_solver_.solve(window_, lever_arm_b_, &corrections_) || !take_step(result)) return false;
  result->converged = step_.share() == 1.0 && is_converged(step_.moved_m());
  return true;
}

// Takes the chain's step.
bool Smoother::take_step(SmootherResult* result) {
  if (!step_.take(corrections_, lever_arm_b_, &window_)) return false;
  result->shortened += step_.share() < 1.0 ? 1 : 0;
  return true;
}

bool Smoother::is_converged(double moved_m) const {
  return moved_m / std::max(sigma_m(), 1e-6) < config_.converged_sigmas;
}

// Lets the minimizer take all steps at weights that are decided once. The chain then gives the
// covariance and what is left to the minimum, and the step where the minimizer has found none.
bool Smoother::minimize(SolveBudget* budget, SmootherResult* result) {
  if (robust_.enabled && config_.reweigh && sigma_m() < kVague_m)
    weights_.update_factors(true, lever_arm_b_, &window_);
  minimizer_->limit(budget);
  const bool minimized = minimizer_->solve(window_, lever_arm_b_, &corrections_);
  minimizer_->limit(nullptr);
  result->iterations = std::max(1, minimizer_->iterations());
  result->left_to_chain = !minimized;
  double moved_m = 0.0;
  if (minimized && !move_states(corrections_, 1.0, &window_, &moved_m)) return false;
  if (!rts_solver_.solve(window_, lever_arm_b_, &corrections_)) return false;
  if (!minimized) return take_step(result);
  moved_m = 0.0;  // what is left
  for (const EkfCorrection& left : corrections_)
    moved_m = std::max(moved_m, left.segment<3>(kPosition).norm());
  result->converged = is_converged(moved_m);
  return true;
}

// How far window and filter are apart after a solve.
WindowAgainstFilter Smoother::against_filter(const Keyframe& newest) const {
  WindowAgainstFilter at;
  const AntennaMotion antenna = antenna_of(newest, lever_arm_b_);
  const Eigen::Vector3d position_e = filter_has_attitude_ ? newest.state.nav.p_e : antenna.p_e;
  at.apart_m = (position_e - filter_position_e_).norm();
  at.window_sigma_m = solved_sigma_m_;
  at.filter_sigma_m = filter_sigma_m_;
  at.filter_is_younger = filter_is_younger();
  int codes = 0, fitting = 0;
  for (const KeyframeMeasurement& measurement : newest.measurements) {
    if (measurement.measurement.observable != Observable::kCode) continue;
    const double residual = linearize(measurement, newest, antenna).residual;
    ++codes;
    fitting += std::abs(residual) < robust_.k1 * std::sqrt(measurement.variance) ? 1 : 0;
  }
  at.codes_fit_window = codes == 0 || 2 * fitting > codes;
  at.codes = codes;
  return at;
}

void Smoother::finish(SmootherResult* result) {
  if (fails_on_purpose(DrilledFailure::kDiverged))
    window_.newest().state.nav.p_e.x() += kDrilledError_m;
  const Keyframe& newest = window_.newest();
  result->has_attitude = newest.has_attitude;
  result->state = newest.state.nav;
  result->time_offset_s = newest.has_attitude ? time_offset_of(newest.state.vehicle) : 0.0;
  result->random_walk = newest.state.random_walk;
  result->filter_is_younger = filter_is_younger();
  EkfCovariance covariance;
  rts_solver_.newest_covariance(&covariance);
  const ActiveStates& active = newest.active;
  for (Index i = 0; i < active.core_size(); ++i) {
    const int row = active.core[static_cast<std::size_t>(i)];
    for (Index j = 0; j < active.core_size(); ++j) {
      const int column = active.core[static_cast<std::size_t>(j)];
      if (row < kInsSize && column < kInsSize) result->covariance(row, column) = covariance(i, j);
    }
  }
  if (newest_follows_ && !has_enough_satellites(window_))
    result->status = SmootherStatus::kFewSatellites;
  for (const KeyframeMeasurement& measurement : newest.measurements)
    result->used += measurement.factor > 0.0 ? 1 : 0;
  solved_sigma_m_ = std::sqrt(std::max(0.0, result->covariance.topLeftCorner<3, 3>().trace()));
  const WindowAgainstFilter at = against_filter(newest);
  if (!result->covariance.allFinite() || !believed_(at)) {
    result->status = SmootherStatus::kDiverged;
    failed_ = true;
  }
  fitting_with_last_ = fitting_;
  if (at.codes >= kFittingCodes) fitting_with_last_ = at.codes_fit_window ? fitting_ + 1 : 0;
  result->filter_may_follow = filter_is_younger() && result->status == SmootherStatus::kOk &&
                              fitting_with_last_ >= kFittingSolves &&
                              seconds_between(newest.time, restarted_) >= kOnItsOwn_s &&
                              filter_sigma_m_ > kAsCertain * solved_sigma_m_;
  if (config_.fixed_lag && result->status == SmootherStatus::kOk && window_.full())
    add_lagged(result);
}

void Smoother::add_lagged(SmootherResult* result) {
  const Keyframe& oldest = window_.at(0);
  LaggedState& lagged = result->lagged;
  rts_solver_.oldest_covariance(window_, &lagged.covariance);
  lagged.valid = lagged.covariance.allFinite();
  lagged.index = oldest.index;
  lagged.has_attitude = oldest.has_attitude;
  lagged.state = oldest.state.nav;
  lagged.time_offset_s = oldest.has_attitude ? time_offset_of(oldest.state.vehicle) : 0.0;
}

void Smoother::commit_or_roll_back(bool taken) {
  if (!solved_) return;
  solved_ = false;
  if (!taken) {
    failed_ = false;
    restore();
    return;
  }
  if (failed_) return;
  window_sigma_m_ = solved_sigma_m_;
  believed_.commit();
  fitting_ = fitting_with_last_;
  const bool caught_up = filter_sigma_m_ < kAsCertain * window_sigma_m_ ||
                         (filter_is_younger() &&
                          seconds_between(window_.newest().time, restarted_) > kLongestYounger_s);
  if (caught_up) restarted_ = GpsTime();
  repropagate();
}

// The oldest factors come first: what leaves the window is linearized for good.
void Smoother::repropagate() {
  int left = kMostRepropagations;
  for (int i = 1; i < window_.size() && left > 0; ++i)
    left -= repropagator_(window_.at(i - 1), &window_.at(i)) ? 1 : 0;
}

void Smoother::save() {
  for (int i = 0; i < window_.size(); ++i) {
    const Keyframe& keyframe = window_.at(i);
    Saved& saved = saved_[static_cast<std::size_t>(i)];
    saved.state = keyframe.state;
    saved.weights_decided = keyframe.weights_decided;
    saved.factors.clear();
    for (const KeyframeMeasurement& measurement : keyframe.measurements)
      saved.factors.push_back(measurement.factor);
  }
}

void Smoother::restore() {
  for (int i = 0; i < window_.size(); ++i) {
    Keyframe& keyframe = window_.at(i);
    const Saved& saved = saved_[static_cast<std::size_t>(i)];
    keyframe.state = saved.state;
    keyframe.weights_decided = saved.weights_decided;
    for (std::size_t m = 0; m < saved.factors.size(); ++m)
      keyframe.measurements[m].factor = saved.factors[m];
  }
}

}  // namespace leonav
