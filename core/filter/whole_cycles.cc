#include "core/filter/whole_cycles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace leonav {
namespace {

constexpr double kKept = 1.0 - 1.0 / 200.0;  // of the logarithm of a density, per pair
constexpr double kLeast = 1e-12;  // of the largest density: no share is ruled out for ever

}  // namespace

void WholeCycles::learn(double likelihood_ratio) {
  double sum = 0.0, moment = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const double share = (static_cast<double>(i) + 0.5) / kSteps;
    weights_[i] = std::pow(weights_[i], kKept) * (share * likelihood_ratio + (1.0 - share));
    sum += weights_[i];
    moment += share * weights_[i];
    largest = std::max(largest, weights_[i]);
  }
  share_ = moment / sum;
  ++pairs_;
  for (double& weight : weights_) weight = std::max(weight / largest, kLeast);
}

double WholeCycles::probability(double likelihood_ratio, double share) {
  const double whole = share * likelihood_ratio;
  return whole / (whole + 1.0 - share);
}

}  // namespace leonav
