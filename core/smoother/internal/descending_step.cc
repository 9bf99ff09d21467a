#include "core/smoother/internal/descending_step.h"

#include <algorithm>

#include "core/smoother/internal/window_cost.h"

namespace leonav {
namespace {

constexpr double kSmallestShare = 0.125;
// Positions are known to 1e-9 m, and what a process allows them beside the velocities is some
// micrometres over a tenth of a second: rounding changes the cost, a number without unit, by less
// than this.
constexpr double kRounding = 1e-3;

}  // namespace

bool move_states(const WindowCorrections& corrections, double share, Window* window,
                 double* moved_m) {
  *moved_m = 0.0;
  for (int i = 0; i < window->size(); ++i) {
    Keyframe& keyframe = window->at(i);
    const EkfCorrection error =
        full_error(keyframe.active, share * corrections[static_cast<std::size_t>(i)]);
    *moved_m = std::max(*moved_m, error.segment<3>(ekf_index::kPosition).norm());
    add(error, keyframe.has_attitude, &keyframe.state);
    if (!is_finite(keyframe.state)) return false;
  }
  return true;
}

DescendingStep::DescendingStep(int capacity)
    : before_(std::make_unique<FilterState[]>(static_cast<std::size_t>(capacity))) {}

bool DescendingStep::take(const WindowCorrections& corrections, const Eigen::Vector3d& lever_arm_b,
                          Window* window) {
  for (int i = 0; i < window->size(); ++i)
    before_[static_cast<std::size_t>(i)] = window->at(i).state;
  for (share_ = 1.0; share_ >= kSmallestShare; share_ *= 0.5) {
    if (!move_states(corrections, share_, window, &moved_m_)) return false;
    // One that is not known does not hold up a step.
    if (!(cost_rise(*window, before_.get(), lever_arm_b) > kRounding)) return true;
    for (int i = 0; i < window->size(); ++i)
      window->at(i).state = before_[static_cast<std::size_t>(i)];
  }
  share_ = moved_m_ = 0.0;
  return true;
}

}  // namespace leonav
