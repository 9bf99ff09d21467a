#include "core/ekf/consistency_watch.h"

#include <algorithm>
#include <cmath>

namespace leonav {

bool ConsistencyWatch::add(double ratio) {
  if (std::isnan(ratio)) return false;
  constexpr double kLargest =
      10.0;  // one leap, which has a test of its own, is not a lasting state
  mean_ += (std::min(ratio, kLargest) - mean_) / kEpochs;
  if (improbable_) {
    improbable_ = mean_ > kRecovered;
    return false;
  }
  improbable_ = mean_ > kImprobable;
  return improbable_;
}

}  // namespace leonav
