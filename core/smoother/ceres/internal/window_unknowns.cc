#include "core/smoother/ceres/internal/window_unknowns.h"

namespace leonav {
namespace {

using Eigen::Index;

// Returns the state of the keyframe before that this state continues unchanged; -1: none.
Index origin(const ProcessFactor& process_factor, Index i) {
  Index from = -1;
  for (Index j = 0; j < process_factor.F.cols(); ++j) {
    if (process_factor.F(i, j) == 0.0) continue;
    if (from >= 0 || process_factor.F(i, j) != 1.0) return -1;
    from = j;
  }
  return from;
}

}  // namespace

bool is_moved(const ProcessFactor& process_factor, Index i) {
  return process_factor.noise(i, i) > 0.0;
}

bool WindowUnknowns::assign_blocks(const Window& window) {
  for (int k = 0; k < window.size(); ++k)
    if (!assign_keyframe(window, k)) return false;
  return true;
}

bool WindowUnknowns::assign_keyframe(const Window& window, int k) {
  const Keyframe& keyframe = window.at(k);
  EkfCorrection prediction_error;  // the estimate minus the prediction by the process factor
  if (k > 0) prediction_error = process_error(window.at(k - 1), keyframe);
  BlockEntries entries(static_cast<std::size_t>(keyframe.active.size()));
  int block = -1;
  for (Index i = 0; i < keyframe.active.size(); ++i) {
    BlockEntry& entry = entries[static_cast<std::size_t>(i)];
    if (k > 0 && !is_moved(keyframe.process_factor, i)) {
      const Index from = origin(keyframe.process_factor, i);
      if (from < 0) return false;
      entry = entries_.back()[static_cast<std::size_t>(from)];
      entry.constant -= prediction_error(i);
      continue;
    }
    const bool first_signal_state =
        i >= keyframe.active.core_size() && (block < 0 || entries[0].block == block);
    if (block < 0 || first_signal_state) {
      block = static_cast<int>(values_.size());
      values_.emplace_back();
    }
    std::vector<double>& values = values_[static_cast<std::size_t>(block)];
    entry = {block, static_cast<Index>(values.size()), 0.0};
    values.push_back(0.0);
  }
  entries_.push_back(entries);
  return true;
}

std::vector<double*> WindowUnknowns::values_of(const std::vector<int>& blocks) {
  std::vector<double*> values;
  for (const int block : blocks) values.push_back(values_[static_cast<std::size_t>(block)].data());
  return values;
}

std::vector<double*> WindowUnknowns::all_values() {
  std::vector<double*> all;
  for (std::vector<double>& values : values_) all.push_back(values.data());
  return all;
}

void WindowUnknowns::add(const Eigen::VectorXd& change) {
  Index i = 0;
  for (std::vector<double>& values : values_)
    for (double& value : values) value += change(i++);
}

EkfCorrection WindowUnknowns::error(int keyframe) const {
  const BlockEntries& entries = this->entries(keyframe);
  EkfCorrection error(static_cast<Index>(entries.size()));
  for (Index i = 0; i < error.size(); ++i) {
    const BlockEntry& entry = entries[static_cast<std::size_t>(i)];
    error(i) =
        values_[static_cast<std::size_t>(entry.block)][static_cast<std::size_t>(entry.offset)] +
        entry.constant;
  }
  return error;
}

}  // namespace leonav
