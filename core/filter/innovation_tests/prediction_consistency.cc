#include "core/filter/innovation_tests/prediction_consistency.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/median.h"
#include "core/filter/update/covariance_inflation.h"
#include "core/robust/common_step.h"

namespace leonav {
namespace {

using namespace ekf_index;
using SmallTable = boost::container::static_vector<double, kMaxMeasurements>;

constexpr double kMedianSquare = 0.4549;  // median of a chi-square with one degree of freedom
constexpr double kAgreeScale = 1.5;       // residuals of measurements that agree, over their sigmas
constexpr double kMaxMissing = 1e12;      // m^2 or (m/s)^2, per epoch
constexpr int kMinRedundancy = 2;         // beyond position and clocks: enough to check them
constexpr std::size_t kManyCount = 7;     // or so many, whatever their clocks
constexpr std::size_t kMinCount = 4;      // fewer do not outvote a prediction ...
constexpr double kMillisecondStep =
    29'979.0;                          // ... unless off by more than a tenth of a millisecond
constexpr double kShiftRatio = 5.0;    // shift over predicted sigma
constexpr double kSpreadShare = 0.33;  // spread about the shift, as a share of it

// Measurements beyond what position (or velocity) and one clock per system need.
int redundancy(const FilterMeasurements& measurements) {
  std::array<bool, kMaxSystemTimes> systems{};
  int count = -3;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.factor <= 0.0) continue;
    ++count;
    for (std::size_t system = 0; system < kMaxSystemTimes; ++system) {
      const auto i = static_cast<Eigen::Index>(system);
      if (measurement.row(kClock + i) != 0.0 || measurement.row(kClockDrift + i) != 0.0)
        systems[system] = true;
    }
  }
  return count - static_cast<int>(std::count(systems.begin(), systems.end(), true));
}

// The sum of `count` squared standard normal variables is larger once in a thousand times
// (Wilson and Hilferty 1931).
double largest_probable(std::size_t count) {
  const double share = 2.0 / (9.0 * static_cast<double>(count));
  return static_cast<double>(count) * std::pow(1.0 - share + 3.09 * std::sqrt(share), 3);
}

}  // namespace

double common_shift(const FilterMeasurements& measurements, Observable observable,
                    const EkfCovariance& covariance) {
  SmallTable innovations, variances;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable != observable) continue;
    innovations.push_back(measurement.innovation);
    variances.push_back(measurement.variance + predicted_variance(measurement, covariance));
  }
  if (innovations.empty()) return 0.0;
  const double shift = median(innovations);
  const double sigma = std::sqrt(median(variances));
  SmallTable deviations;
  for (const double innovation : innovations) deviations.push_back(std::abs(innovation - shift));
  const double spread = 1.4826 * median(deviations);
  // Half of the satellites reflected is no shift.
  const bool shared = two_thirds_share({innovations.data(), innovations.size()}, shift);
  const bool agree = shared && spread < kSpreadShare * std::abs(shift);
  const bool many = innovations.size() >= kMinCount;
  const bool huge = observable == Observable::kCode && std::abs(shift) > kMillisecondStep;
  if (agree && (many || huge) && std::abs(shift) > kShiftRatio * sigma) return shift;
  return 0.0;
}

double consistency_ratio(const ClockRemovedInnovations& table) {
  if (table.size() < kMinCount) return std::numeric_limits<double>::quiet_NaN();
  SmallTable ratios;
  for (const ClockRemovedInnovation& entry : table)
    ratios.push_back(std::abs(entry.innovation) / std::sqrt(entry.variance));
  return median(ratios) / std::sqrt(kMedianSquare);
}

bool median_is_consistent(const ClockRemovedInnovations& table, double suspect) {
  return consistency_ratio(table) * std::sqrt(kMedianSquare) < suspect;
}

bool all_are_consistent(const ClockRemovedInnovations& table) {
  return std::all_of(table.begin(), table.end(), [](const ClockRemovedInnovation& entry) {
    return entry.innovation * entry.innovation < 9.0 * entry.variance;
  });
}

void set_prior_ratios(const ClockRemovedInnovations& table, FilterMeasurements* measurements) {
  if (table.size() < kMinCount) return;
  for (const ClockRemovedInnovation& entry : table)
    (*measurements)[entry.index].prior_ratio =
        std::abs(entry.innovation) / std::sqrt(entry.variance);
}

double unmodelled_prior_variance(const RobustConfig& robust, const FilterMeasurements& measurements,
                                 Observable observable, const ClockRemovedInnovations& table,
                                 const EkfCovariance& covariance, double suspect,
                                 RobustUpdate* robust_update) {
  if (table.size() < kMinCount || median_is_consistent(table, suspect)) return 0.0;
  FilterMeasurements offered;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable != observable) continue;
    offered.push_back(measurement);
    offered.back().factor = 1.0;
  }
  const bool many = offered.size() >= kManyCount;
  if (!many && redundancy(offered) < kMinRedundancy) return 0.0;
  SmallTable missing;
  for (const ClockRemovedInnovation& entry : table)
    missing.push_back(std::pow(entry.innovation, 2) / kMedianSquare - entry.measured_variance);
  // Twice: along a line of sight, and less what the satellites share, only part of it is seen.
  const double variance = std::clamp(2.0 * median(missing), 0.0, kMaxMissing);

  // Few measurements are soon fitted: they are tested as if their errors did not last.
  if (!many)
    for (FilterMeasurement& measurement : offered) measurement.gain_variance = measurement.variance;
  // Would they agree?
  EkfCovariance wide = covariance;
  inflate_covariance(observable, variance, 0.0, &wide);
  const RobustUpdateResult fit = (*robust_update)(robust, &offered, &wide);
  std::size_t kept = 0;
  for (const FilterMeasurement& measurement : offered) kept += measurement.factor > 0.0 ? 1 : 0;
  const double scale = fit.scale[static_cast<std::size_t>(observable)];
  // A median does not see the few that are far out; the sum of squares of those kept does.
  bool agree = scale < (many ? kAgreeScale : suspect) && 4 * kept >= 3 * offered.size();
  if (!many) agree = agree && redundancy(offered) >= kMinRedundancy;
  agree = agree && fit.nis < largest_probable(kept);
  return agree ? variance : 0.0;
}

}  // namespace leonav
