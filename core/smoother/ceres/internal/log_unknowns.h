// LogUnknowns arranges the unknown errors of a LogGraph in parameter blocks for Ceres.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/smoother/batch/log_graph.h"

namespace leonav {

// The unknowns are errors, zero at the present estimates. A keyframe has a block of those core
// states that the process moves; a state that it carries over unchanged for many keyframes is one
// block for all of them, and so is each piece of an ambiguity.
class LogUnknowns {
 public:
  // The error of a core state is values(block)[offset] + constant.
  struct Entry {
    int block = 0;
    int offset = 0;
    double constant = 0.0;
  };
  // Index-parallel to a keyframe's active states.
  using Entries = std::vector<Entry>;

  // Lays out the blocks; false if the process changes a state only in combination with others.
  bool assign(const LogGraph& graph);

  const Entries& entries(int keyframe) const {
    return entries_[static_cast<std::size_t>(keyframe)];
  }
  int block_of_piece(int piece) const { return first_piece_ + piece; }
  int size_of(int block) const {
    return static_cast<int>(values_[static_cast<std::size_t>(block)].size());
  }
  double* values(int block) { return values_[static_cast<std::size_t>(block)].data(); }
  int blocks() const { return static_cast<int>(values_.size()); }
  // Returns the present error of a keyframe's core states.
  Eigen::VectorXd error(int keyframe) const;

 private:
  int add_block(int size);

  std::vector<Entries> entries_;
  std::vector<std::vector<double>> values_;
  int first_piece_ = 0;
};

// Returns whether the process that leads to a keyframe moves its active state `i`.
bool is_moved(const LogProcess& process, Eigen::Index i);

}  // namespace leonav
