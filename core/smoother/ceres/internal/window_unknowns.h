// WindowUnknowns arranges the unknown errors of a window's keyframes in parameter blocks for Ceres.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/smoother/window.h"

namespace leonav {

// The unknowns are the errors of the keyframes' states, zero at the present estimates.
//
// Every keyframe has a block of core states and one of ambiguities. States that the process has
// carried over unchanged are not in them: they are found in the blocks of the keyframe before.
class WindowUnknowns {
 public:
  // The error of an active state is values(block)[offset] + constant.
  struct BlockEntry {
    int block = 0;
    Eigen::Index offset = 0;
    double constant = 0.0;
  };
  using BlockEntries = std::vector<BlockEntry>;  // index-parallel to the keyframe's active states

  // Lays out the blocks; false if the process changes a state only in combination with others.
  bool assign_blocks(const Window& window);

  // Returns where the active states of a keyframe are found.
  const BlockEntries& entries(int keyframe) const {
    return entries_[static_cast<std::size_t>(keyframe)];
  }
  Eigen::Index size_of(int block) const {
    return static_cast<Eigen::Index>(values_[static_cast<std::size_t>(block)].size());
  }
  // Returns pointers to the values of the given blocks, and of all.
  std::vector<double*> values_of(const std::vector<int>& blocks);
  std::vector<double*> all_values();
  // Adds `change` to the values of all blocks, one block after the other.
  void add(const Eigen::VectorXd& change);
  // Returns the present error of a keyframe, in active states.
  EkfCorrection error(int keyframe) const;

 private:
  bool assign_keyframe(const Window& window, int k);

  std::vector<BlockEntries> entries_;
  std::vector<std::vector<double>> values_;
};

// Returns whether the process changes active state `i`.
bool is_moved(const ProcessFactor& process_factor, Eigen::Index i);

}  // namespace leonav
