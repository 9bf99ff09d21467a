#include "core/smoother/repropagation.h"

#include "core/smoother/window.h"

namespace leonav {
namespace {

using Eigen::Index;

// Information of motion constraints about the inertial states before; they concern no others.
void take_information(const FilterProcess& process, const ActiveStates& active,
                      ProcessFactor* process_factor) {
  process_factor->information.setZero(active.core_size(), active.core_size());
  process_factor->gradient.setZero(active.size());
  if (!process.has_information) return;
  for (Index i = 0; i < active.core_size(); ++i) {
    const int row = active.core[static_cast<std::size_t>(i)];
    process_factor->gradient(i) = process.gradient(row);
    for (Index j = 0; j < active.core_size(); ++j)
      process_factor->information(i, j) =
          process.information(row, active.core[static_cast<std::size_t>(j)]);
  }
}

}  // namespace

void Repropagator::integrate(const Keyframe& before, Keyframe* keyframe) {
  ProcessFactor& process_factor = keyframe->process_factor;
  if (!before.has_attitude || !keyframe->has_attitude || !keyframe->block_complete) return;
  const StateEstimate& estimate = propagation_(
      before.state, keyframe->sample_before_block, {keyframe->block.data(), keyframe->block.size()},
      {keyframe->instants.data(), keyframe->instants.size()}, keyframe->time);
  const FilterProcess& process = estimate.process();
  FilterState to = predicted_state(before, *keyframe);
  const CoreState whole = uncorrected_state(estimate);
  to.nav = whole.nav;
  to.vehicle = whole.vehicle;
  process_factor.has_information = process.has_information;
  if (process.has_information) take_information(process, before.active, &process_factor);
  for (Index i = 0; i < keyframe->active.core_size(); ++i) {
    const int row = keyframe->active.core[static_cast<std::size_t>(i)];
    if (!is_of_motion(row)) continue;
    for (Index j = 0; j < before.active.core_size(); ++j) {
      const int column = before.active.core[static_cast<std::size_t>(j)];
      process_factor.F(i, j) = is_of_motion(column) ? process.transition(row, column) : 0.0;
    }
    for (Index j = 0; j < keyframe->active.core_size(); ++j) {
      const int column = keyframe->active.core[static_cast<std::size_t>(j)];
      process_factor.noise(i, j) = process_factor.noise(j, i) =
          is_of_motion(column) ? process.noise(row, column) : 0.0;
    }
  }
  process_factor.from = before.state;
  process_factor.to = to;
}

bool Repropagator::operator()(const Keyframe& before, Keyframe* keyframe) {
  if (!keyframe->has_attitude || !keyframe->block_complete) return false;
  if (!is_far(before.state, keyframe->process_factor.from)) return false;
  integrate(before, keyframe);
  ++repropagations_;
  return true;
}

}  // namespace leonav
