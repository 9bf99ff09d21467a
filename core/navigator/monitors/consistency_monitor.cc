#include "core/navigator/monitors/consistency_monitor.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

constexpr double kEpochs = 30.0;  // of the exponential window
constexpr double kInconsistent = 2.0;
constexpr double kRecovered = 1.5;
constexpr double kLargest = 10.0;  // one leap, which has a test of its own, is not a lasting state

}  // namespace

bool ConsistencyMonitor::add(double ratio) {
  if (std::isnan(ratio)) return false;
  mean_ += (std::min(ratio, kLargest) - mean_) / kEpochs;
  if (inconsistent_) {
    inconsistent_ = mean_ > kRecovered;
    return false;
  }
  inconsistent_ = mean_ > kInconsistent;
  return inconsistent_;
}

}  // namespace leonav
