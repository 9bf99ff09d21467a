#include "core/smoother/window.h"

#include <algorithm>

#include "core/base/square.h"
#include "core/smoother/internal/definite_inverse.h"
#include "core/smoother/process_propagation.h"

namespace leonav {
namespace {

using Eigen::Index;

ActiveStates active_states(const KeyframeInput& input) {
  ActiveStates active;
  active.before_ambiguities = input.state.first_ambiguity();
  for (int i = 0; i < active.before_ambiguities; ++i)
    if (input.covariance(i, i) > 0.0) active.core.push_back(i);
  active.ambiguities = static_cast<int>(input.state.ambiguities.size());
  return active;
}

// The states of motion of the keyframe before, whose filter had an attitude; all others of the
// filter.
ActiveStates states_with_motion_of(const ActiveStates& before, const KeyframeInput& input) {
  ActiveStates active = active_states(input);
  active.core.clear();
  auto moving = before.core.begin();
  for (int i = 0; i < active.before_ambiguities; ++i) {
    while (moving != before.core.end() && *moving < i) ++moving;
    const bool estimated = is_of_motion(i) ? moving != before.core.end() && *moving == i
                                           : input.covariance(i, i) > 0.0;
    if (estimated) active.core.push_back(i);
  }
  return active;
}

void take_motion(const CoreState& of, CoreState* state) {
  state->nav = of.nav;
  state->vehicle = of.vehicle;
  state->random_walk = of.random_walk;
}

Index whole_index(const ActiveStates& active, Index i) {
  if (i < active.core_size()) return active.core[static_cast<std::size_t>(i)];
  return active.before_ambiguities + i - active.core_size();
}

constexpr double kUnknownAmbiguity = 1e3;  // m, 1 sigma of one that begins anew

bool make_process_factor(const KeyframeInput& input, const Keyframe& before, Keyframe* keyframe) {
  ProcessFactor& process_factor = keyframe->process_factor;
  const ActiveStates& rows = keyframe->active;
  const ActiveStates& columns = before.active;
  if (input.process.transition.cols() != columns.before_ambiguities + columns.ambiguities + 1)
    return false;
  process_factor.F.resize(rows.size(), columns.size());
  EkfCovariance& noise = process_factor.noise;
  noise.resize(rows.size(), rows.size());
  for (Index i = 0; i < rows.size(); ++i) {
    const Index row = whole_index(rows, i);
    for (Index j = 0; j < columns.size(); ++j)
      process_factor.F(i, j) = input.process.transition(row, whole_index(columns, j));
    for (Index j = 0; j < rows.size(); ++j)
      noise(i, j) = input.process.noise(row, whole_index(rows, j));
  }
  process_factor.has_information = input.process.has_information;
  if (process_factor.has_information) {
    const Index core = columns.core_size();
    process_factor.information.resize(core, core);
    process_factor.gradient.resize(columns.size());
    for (Index i = 0; i < columns.size(); ++i)
      process_factor.gradient(i) = input.process.gradient(whole_index(columns, i));
    for (Index i = 0; i < core; ++i)
      for (Index j = 0; j < core; ++j)
        process_factor.information(i, j) =
            input.process.information(whole_index(columns, i), whole_index(columns, j));
    if (!process_factor.information.allFinite() || !process_factor.gradient.allFinite())
      return false;
  }
  process_factor.joins = joins_of(input);
  return process_factor.F.allFinite() && noise.allFinite();
}

// The filter's process of clocks, delays and ambiguities, and none of the motion. Returns false if
// the filter's did not begin at the keyframe before.
bool keep_without_motion(const KeyframeInput& input, const Keyframe& before, Keyframe* keyframe) {
  ProcessFactor& process_factor = keyframe->process_factor;
  const ActiveStates& rows = keyframe->active;
  const ActiveStates& columns = before.active;
  const ProcessMatrix& transition = input.process.transition;
  if (!input.follows_previous ||
      transition.cols() != columns.before_ambiguities + columns.ambiguities + 1)
    return false;
  process_factor.from = input.from;
  process_factor.to = input.prior;
  take_motion(before.state, &process_factor.from);
  take_motion(before.state, &process_factor.to);
  process_factor.has_information = false;
  process_factor.joins = joins_of(input);
  process_factor.F.setZero(rows.size(), columns.size());
  process_factor.noise.setZero(rows.size(), rows.size());
  const auto moves = [](const ActiveStates& active, Index i) {
    return i < active.core_size() && is_of_motion(active.core[static_cast<std::size_t>(i)]);
  };
  for (Index i = 0; i < rows.size(); ++i) {
    if (moves(rows, i)) continue;
    const Index row = whole_index(rows, i);
    for (Index j = 0; j < columns.size(); ++j)
      if (!moves(columns, j)) process_factor.F(i, j) = transition(row, whole_index(columns, j));
    for (Index j = 0; j < rows.size(); ++j)
      if (!moves(rows, j))
        process_factor.noise(i, j) = input.process.noise(row, whole_index(rows, j));
  }
  return process_factor.F.allFinite() && process_factor.noise.allFinite();
}

// A process of which nothing is known but that the delays stay about the same.
void part(const KeyframeInput& input, const Keyframe& before, Keyframe* keyframe) {
  ProcessFactor& process_factor = keyframe->process_factor;
  const ActiveStates& rows = keyframe->active;
  process_factor.from = before.state;
  process_factor.to = input.state;
  if (!input.has_attitude) take_motion(before.state, &process_factor.to);
  process_factor.to.wet_delay_m = before.state.wet_delay_m;
  process_factor.to.carrier_clock_m = before.state.carrier_clock_m;
  process_factor.to.ionosphere_m = before.state.ionosphere_m;
  process_factor.has_information = false;
  process_factor.joins.clear();
  process_factor.F.setZero(rows.size(), before.active.size());
  process_factor.noise.setZero(rows.size(), rows.size());
  for (Index i = 0; i < rows.size(); ++i) {
    const auto row = static_cast<int>(whole_index(rows, i));
    process_factor.noise(i, i) =
        i < rows.core_size() ? restarted_variance(row) : square(kUnknownAmbiguity);
    if (i < rows.core_size() && row >= ekf_index::kWetDelay && row < ekf_index::kSize)
      for (Index j = 0; j < before.active.core_size(); ++j)
        if (before.active.core[static_cast<std::size_t>(j)] == row) process_factor.F(i, j) = 1.0;
  }
}

void copy_common(const KeyframeInput& input, Keyframe* keyframe) {
  keyframe->index = input.index;
  keyframe->time = input.time;
  keyframe->has_attitude = input.has_attitude;
  keyframe->active = active_states(input);
  keyframe->measured_rate_b = input.measured_rate_b;
  keyframe->acceleration_e = input.acceleration_e;
  keyframe->vertical_antenna_offset_e = input.vertical_antenna_offset_e;
  keyframe->weights_decided = false;
}

void copy_data(const KeyframeInput& input, Keyframe* keyframe) {
  keyframe->satellites = input.satellites;
  keyframe->measurements = input.measurements;
  keyframe->block = input.block;
  keyframe->block_complete = input.block_complete;
  keyframe->sample_before_block = input.sample_before_block;
  keyframe->instants = input.instants;
}

}  // namespace

Window::Window(int capacity)
    : capacity_(std::clamp(capacity, 2, static_cast<int>(kMaxWindow))),
      slots_(std::make_unique<Keyframe[]>(static_cast<std::size_t>(capacity_))) {}

Window::Window(const Window& other) : Window(other.capacity_) {
  first_ = other.first_;
  size_ = other.size_;
  prior_ = other.prior_;
  for (int i = 0; i < size_; ++i) at(i) = other.at(i);
}

bool Window::start(const KeyframeInput& input) {
  first_ = 0;
  size_ = 0;
  Keyframe& keyframe = slots_[0];
  copy_common(input, &keyframe);
  keyframe.satellites.clear();
  keyframe.measurements.clear();
  keyframe.block.clear();
  keyframe.instants.clear();
  keyframe.state = input.state;
  prior_.at = input.state;
  const ActiveStates& active = keyframe.active;
  EkfCovariance covariance(active.size(), active.size());
  for (Index i = 0; i < active.size(); ++i)
    for (Index j = 0; j < active.size(); ++j)
      covariance(i, j) = input.covariance(whole_index(active, i), whole_index(active, j));
  if (active.size() == 0 || !invert(covariance, &prior_.information)) return false;
  prior_.gradient.setZero(active.size());
  size_ = 1;
  return true;
}

bool Window::append(const KeyframeInput& input) {
  const Keyframe& before = newest();
  Keyframe& keyframe = slots_[slot(size_)];
  copy_common(input, &keyframe);
  copy_data(input, &keyframe);
  keyframe.process_factor.from = input.from;
  keyframe.process_factor.to = input.prior;
  if (!make_process_factor(input, before, &keyframe)) return false;
  keyframe.state = predicted_state(before, keyframe);
  ++size_;
  return true;
}

void Window::append_apart(const KeyframeInput& input) {
  const Keyframe& before = newest();
  Keyframe& keyframe = slots_[slot(size_)];
  copy_common(input, &keyframe);
  copy_data(input, &keyframe);
  keyframe.state = input.state;
  if (!input.has_attitude) {
    keyframe.has_attitude = true;
    keyframe.active = states_with_motion_of(before.active, input);
    keyframe.vertical_antenna_offset_e.setZero();
    take_motion(before.state, &keyframe.state);
  }
  if (!keep_without_motion(input, before, &keyframe)) part(input, before, &keyframe);
  ++size_;
}

void Window::drop_oldest(const WindowPrior& prior) {
  prior_ = prior;
  first_ = slot(1);
  --size_;
}

bool can_bridge(const Window& window, const KeyframeInput& input) {
  if (window.size() == 0 || !input.valid || input.attitude_replaced || input.ends_window ||
      !input.block_complete)
    return false;
  const Keyframe& newest = window.newest();
  const double apart_s = seconds_between(input.time, newest.time);
  const ImuSample& sample_before = input.sample_before_block;
  if (sample_before.interval_ns != 0 && sample_before.time > newest.time) return false;
  return newest.has_attitude && newest.active.before_ambiguities == input.state.first_ambiguity() &&
         apart_s > 0.0 && apart_s < kLongestBridge_s;
}

FilterState predicted_state(const Keyframe& before, const Keyframe& keyframe) {
  const EkfCorrection moved =
      active_part(before.active, difference(before.state, keyframe.process_factor.from));
  FilterState state = keyframe.process_factor.to;
  add(full_error(keyframe.active, keyframe.process_factor.F * moved), keyframe.has_attitude,
      &state);
  return state;
}

EkfCorrection process_error(const Keyframe& before, const Keyframe& keyframe) {
  return process_error(before.active, before.state, keyframe, keyframe.state);
}

EkfCorrection process_error(const ActiveStates& active_before, const FilterState& before,
                            const Keyframe& keyframe, const FilterState& state) {
  EkfCorrection error = active_part(keyframe.active, difference(state, keyframe.process_factor.to));
  error.noalias() -= keyframe.process_factor.F *
                     active_part(active_before, difference(before, keyframe.process_factor.from));
  return error;
}

}  // namespace leonav
