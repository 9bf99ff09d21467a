#include "core/navigator/monitors/independent_solution.h"

#include <algorithm>

namespace leonav {
namespace {

constexpr int kMinRedundancyPerOutlier = 3;

int outlier_count(const MeasurementEpoch& epoch, Observable observable) {
  return static_cast<int>(std::count_if(
      epoch.measurements.begin(), epoch.measurements.end(), [&](const Measurement& m) {
        return m.observable == observable && m.reason == Reason::kOutlier;
      }));
}

}  // namespace

bool most_codes_agree(const MeasurementEpoch& epoch) {
  int offered = 0, used = 0;
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCode) continue;
    ++offered;
    used += is_used(measurement.reason) ? 1 : 0;
  }
  return 3 * used >= 2 * offered;
}

bool all_codes_agree(const MeasurementEpoch& epoch) {
  int used = 0, downweighted = 0;
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCode) continue;
    if (measurement.reason == Reason::kOutlier) return false;
    used += measurement.reason == Reason::kUsed ? 1 : 0;
    downweighted += measurement.reason == Reason::kDownweighted ? 1 : 0;
  }
  return 4 * downweighted <= used;
}

bool is_highly_redundant(const IndependentSolution& solution) {
  const int outliers = std::max(outlier_count(*solution.measurements, Observable::kCode),
                                outlier_count(*solution.measurements, Observable::kDoppler));
  return redundancy(solution.point) >=
         std::max(kMinResetRedundancy, kMinRedundancyPerOutlier * outliers);
}

}  // namespace leonav
