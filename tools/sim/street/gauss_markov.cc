#include "tools/sim/street/gauss_markov.h"

#include <algorithm>
#include <cmath>

namespace leonav::sim {
namespace {

const double kAngle = std::acos(std::exp(-1.0 / GaussMarkov::kNodes));

}  // namespace

GaussMarkov::GaussMarkov(std::uint64_t key)
    : random_(key), left_(random_.draw()), innovation_(random_.draw()) {}

GaussMarkov::Value GaussMarkov::at(double argument) {
  const double place = std::max(kNodes * argument, node_);
  for (; node_ + 1.0 <= place; node_ += 1.0) {
    left_ = std::cos(kAngle) * left_ + std::sin(kAngle) * innovation_;
    innovation_ = random_.draw();
  }
  const double x = place - node_;
  const double angle = kAngle * x * x * (3.0 - 2.0 * x);
  const double angle_slope = kNodes * kAngle * 6.0 * x * (1.0 - x);
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * left_ + s * innovation_, (c * innovation_ - s * left_) * angle_slope};
}

}  // namespace leonav::sim
