// What is unknown in a window, in blocks.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/smoother/window.h"

namespace leonav {

// Errors of the keyframes' states, zero where these are now: per keyframe a block of core states
// and one of ambiguities, without those that the process has carried over unmoved from the keyframe
// before, which are found in its blocks.
class WindowUnknowns {
 public:
  // An active state's error is values(block)[offset] + constant.
  struct Place {
    int block = 0;
    Eigen::Index offset = 0;
    double constant = 0.0;
  };
  using Places = std::vector<Place>;  // index-parallel to the keyframe's active states

  // False: the process moves a state only together with others.
  bool lay_out(const Window& window);

  const Places& places(int keyframe) const { return places_[static_cast<std::size_t>(keyframe)]; }
  Eigen::Index size_of(int block) const {
    return static_cast<Eigen::Index>(values_[static_cast<std::size_t>(block)].size());
  }
  std::vector<double*> values_of(const std::vector<int>& blocks);
  std::vector<double*> all_values();
  // To all blocks' values, one after the other.
  void add(const Eigen::VectorXd& change);
  EkfCorrection error(int keyframe) const;

 private:
  bool place_keyframe(const Window& window, int k);

  std::vector<Places> places_;
  std::vector<std::vector<double>> values_;
};

// Whether the process moves active state `i`.
bool is_moved(const KeyframeLink& link, Eigen::Index i);

}  // namespace leonav
