#include "core/ceres/window_unknowns.h"

namespace leonav {
namespace {

using Eigen::Index;

// The state before that is this one, if the process carries it over as it is; -1: none.
Index origin(const KeyframeLink& link, Index i) {
  Index from = -1;
  for (Index j = 0; j < link.F.cols(); ++j) {
    if (link.F(i, j) == 0.0) continue;
    if (from >= 0 || link.F(i, j) != 1.0) return -1;
    from = j;
  }
  return from;
}

}  // namespace

bool is_moved(const KeyframeLink& link, Index i) { return link.noise(i, i) > 0.0; }

bool WindowUnknowns::lay_out(const Window& window) {
  for (int k = 0; k < window.size(); ++k)
    if (!place_keyframe(window, k)) return false;
  return true;
}

bool WindowUnknowns::place_keyframe(const Window& window, int k) {
  const Keyframe& keyframe = window.at(k);
  EkfCorrection apart;  // of the estimate, from where the link leads
  if (k > 0) apart = link_error(window.at(k - 1), keyframe);
  Places places(static_cast<std::size_t>(keyframe.active.size()));
  int block = -1;
  for (Index i = 0; i < keyframe.active.size(); ++i) {
    Place& place = places[static_cast<std::size_t>(i)];
    if (k > 0 && !is_moved(keyframe.link, i)) {
      const Index from = origin(keyframe.link, i);
      if (from < 0) return false;
      place = places_.back()[static_cast<std::size_t>(from)];
      place.constant -= apart(i);
      continue;
    }
    const bool first_ambiguity =
        i >= keyframe.active.core_size() && (block < 0 || places[0].block == block);
    if (block < 0 || first_ambiguity) {
      block = static_cast<int>(values_.size());
      values_.emplace_back();
    }
    std::vector<double>& values = values_[static_cast<std::size_t>(block)];
    place = {block, static_cast<Index>(values.size()), 0.0};
    values.push_back(0.0);
  }
  places_.push_back(places);
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
  const Places& places = this->places(keyframe);
  EkfCorrection error(static_cast<Index>(places.size()));
  for (Index i = 0; i < error.size(); ++i) {
    const Place& place = places[static_cast<std::size_t>(i)];
    error(i) =
        values_[static_cast<std::size_t>(place.block)][static_cast<std::size_t>(place.offset)] +
        place.constant;
  }
  return error;
}

}  // namespace leonav
