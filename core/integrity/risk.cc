#include "core/integrity/risk.h"

#include <algorithm>

namespace leonav {
namespace {

constexpr double kHour_s = 3600.0;

}  // namespace

double samples_per_hour(double correlation_s) { return std::max(1.0, kHour_s / correlation_s); }

double risk_per_sample(double risk_per_hour, double correlation_s) {
  return risk_per_hour / samples_per_hour(correlation_s);
}

double fault_probability(double rate_per_hour, double exposure_s, double correlation_s) {
  const double present_s = std::max(exposure_s, kHour_s / samples_per_hour(correlation_s));
  return std::min(1.0, rate_per_hour * present_s / kHour_s);
}

}  // namespace leonav
