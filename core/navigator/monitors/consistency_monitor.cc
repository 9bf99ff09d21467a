#include "core/navigator/monitors/consistency_monitor.h"

#include <algorithm>
#include <cmath>

namespace leonav {

bool ConsistencyMonitor::add(double ratio) {
  if (std::isnan(ratio)) return false;
  constexpr double kLargest =
      10.0;  // one leap, which has a test of its own, is not a lasting state
  mean_ += (std::min(ratio, kLargest) - mean_) / kEpochs;
  if (inconsistent_) {
    inconsistent_ = mean_ > kRecovered;
    return false;
  }
  inconsistent_ = mean_ > kInconsistent;
  return inconsistent_;
}

}  // namespace leonav
