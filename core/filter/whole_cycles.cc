#include "core/filter/whole_cycles.h"

#include <algorithm>
#include <cstddef>

namespace leonav {

void WholeCycles::learn(double likelihood_ratio) {
  double sum = 0.0, moment = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const double share = (static_cast<double>(i) + 0.5) / kSteps;
    weights_[i] *= share * likelihood_ratio + (1.0 - share);
    sum += weights_[i];
    moment += share * weights_[i];
    largest = std::max(largest, weights_[i]);
  }
  share_ = moment / sum;
  ++pairs_;
  for (double& weight : weights_) weight /= largest;
}

double WholeCycles::probability(double likelihood_ratio) const {
  const double whole = share_ * likelihood_ratio;
  return whole / (whole + 1.0 - share_);
}

}  // namespace leonav
