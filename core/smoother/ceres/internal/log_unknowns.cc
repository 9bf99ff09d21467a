#include "core/smoother/ceres/internal/log_unknowns.h"

namespace leonav {
namespace {

using Eigen::Index;

// Returns the state of the keyframe before that this state continues unchanged; -1: none.
Index origin(const LogProcess& process, Index i) {
  Index from = -1;
  for (Index j = 0; j < process.F.cols(); ++j) {
    if (process.F(i, j) == 0.0) continue;
    if (from >= 0 || process.F(i, j) != 1.0) return -1;
    from = j;
  }
  return from;
}

// By keyframe and active state, whether the next keyframe carries it over unchanged.
std::vector<std::vector<bool>> carried_over(const LogGraph& graph) {
  std::vector<std::vector<bool>> carried(static_cast<std::size_t>(graph.size()));
  for (int k = 0; k < graph.size(); ++k)
    carried[static_cast<std::size_t>(k)].resize(static_cast<std::size_t>(graph.at(k).core_size()));
  for (int k = 1; k < graph.size(); ++k) {
    const LogProcess& process = graph.at(k).process;
    if (!process.exists) continue;
    for (Index i = 0; i < graph.at(k).core_size(); ++i) {
      if (is_moved(process, i)) continue;
      const Index from = origin(process, i);
      if (from >= 0)
        carried[static_cast<std::size_t>(k - 1)][static_cast<std::size_t>(from)] = true;
    }
  }
  return carried;
}

}  // namespace

bool is_moved(const LogProcess& process, Index i) { return process.noise(i, i) > 0.0; }

int LogUnknowns::add_block(int size) {
  values_.emplace_back(static_cast<std::size_t>(size), 0.0);
  return blocks() - 1;
}

bool LogUnknowns::assign(const LogGraph& graph) {
  const auto carried = carried_over(graph);
  for (int k = 0; k < graph.size(); ++k) {
    const LogKeyframe& keyframe = graph.at(k);
    const LogProcess& process = keyframe.process;
    Eigen::VectorXd prediction_error;  // the estimate minus what the process predicts
    if (process.exists) {
      const LogKeyframe& before = graph.at(k - 1);
      prediction_error = active_part(keyframe.active, difference(keyframe.state, process.to));
      prediction_error -=
          process.F * active_part(before.active, difference(before.state, process.from));
    }
    Entries entries(static_cast<std::size_t>(keyframe.core_size()));
    int block = -1;
    for (Index i = 0; i < keyframe.core_size(); ++i) {
      Entry& entry = entries[static_cast<std::size_t>(i)];
      if (process.exists && !is_moved(process, i)) {
        const Index from = origin(process, i);
        if (from < 0) return false;
        entry = entries_.back()[static_cast<std::size_t>(from)];
        entry.constant -= prediction_error(i);
        continue;
      }
      if (carried[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)]) {
        entry = {add_block(1), 0, 0.0};
        continue;
      }
      if (block < 0) block = add_block(0);
      std::vector<double>& values = values_[static_cast<std::size_t>(block)];
      entry = {block, static_cast<int>(values.size()), 0.0};
      values.push_back(0.0);
    }
    entries_.push_back(entries);
  }
  first_piece_ = blocks();
  for (std::size_t i = 0; i < graph.pieces().size(); ++i) add_block(1);
  return true;
}

Eigen::VectorXd LogUnknowns::error(int keyframe) const {
  const Entries& of = entries(keyframe);
  Eigen::VectorXd error(static_cast<Index>(of.size()));
  for (Index i = 0; i < error.size(); ++i) {
    const Entry& entry = of[static_cast<std::size_t>(i)];
    error(i) =
        values_[static_cast<std::size_t>(entry.block)][static_cast<std::size_t>(entry.offset)] +
        entry.constant;
  }
  return error;
}

}  // namespace leonav
