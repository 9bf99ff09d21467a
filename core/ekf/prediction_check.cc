#include "core/ekf/prediction_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/ekf/median.h"

namespace leonav {
namespace {

using namespace ekf_index;
using SmallTable = boost::container::static_vector<double, kMaxMeasurements>;

constexpr double kMedianSquare = 0.4549;  // median of a chi-square with one degree of freedom
constexpr double kMaxInflation = 1e6;     // per epoch
constexpr int kMinRedundancy = 2;         // beyond position and clocks: enough to check them
constexpr std::size_t kManyCount = 7;     // or so many, whatever their clocks
constexpr std::size_t kMinCount = 4;      // fewer do not outvote a prediction ...
constexpr double kMillisecondStep =
    29'979.0;                          // ... unless off by more than a tenth of a millisecond
constexpr double kShiftRatio = 5.0;    // shift over predicted sigma
constexpr double kSpreadShare = 0.33;  // spread about the shift, as a share of it

// Measurements beyond what position (or velocity) and one clock per time base need.
int redundancy(const FilterMeasurements& measurements) {
  std::array<bool, kMaxTimeBases> bases{};
  int count = -3;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.factor <= 0.0) continue;
    ++count;
    for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
      const auto i = static_cast<Eigen::Index>(base);
      if (measurement.row(kClock + i) != 0.0 || measurement.row(kClockDrift + i) != 0.0)
        bases[base] = true;
    }
  }
  return count - static_cast<int>(std::count(bases.begin(), bases.end(), true));
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
  const bool agree = spread < kSpreadShare * std::abs(shift);
  const bool many = innovations.size() >= kMinCount;
  const bool huge = observable == Observable::kCode && std::abs(shift) > kMillisecondStep;
  if (agree && (many || huge) && std::abs(shift) > kShiftRatio * sigma) return shift;
  return 0.0;
}

double consistency_ratio(const FilterMeasurements& measurements, Observable observable,
                         const EkfCovariance& covariance) {
  SmallTable ratios;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable != observable) continue;
    const double variance = measurement.variance + predicted_variance(measurement, covariance);
    ratios.push_back(std::abs(measurement.innovation) / std::sqrt(variance));
  }
  if (ratios.size() < kMinCount) return std::numeric_limits<double>::quiet_NaN();
  return median(ratios) / std::sqrt(kMedianSquare);
}

double prediction_inflation(const RobustConfig& robust, const FilterMeasurements& measurements,
                            Observable observable, const EkfCovariance& covariance, double suspect,
                            RobustUpdate* robust_update) {
  SmallTable ratios, factors;
  FilterMeasurements offered;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable != observable) continue;
    offered.push_back(measurement);
    offered.back().factor = 1.0;
    const double predicted = predicted_variance(measurement, covariance);
    const double square = measurement.innovation * measurement.innovation;
    ratios.push_back(square / (predicted + measurement.variance));
    if (predicted > 0.0)
      factors.push_back((square / kMedianSquare - measurement.variance) / predicted);
  }
  const bool many = offered.size() >= kManyCount;
  if (factors.empty() || (!many && redundancy(offered) < kMinRedundancy)) return 1.0;
  if (std::sqrt(median(ratios)) < suspect) return 1.0;
  const double factor = std::clamp(median(factors), 1.0, kMaxInflation);

  // Few measurements are soon fitted: they are tested as if nothing stayed alike in time.
  if (!many)
    for (FilterMeasurement& measurement : offered) measurement.gain_variance = measurement.variance;
  // Would they agree?
  EkfCovariance wide = covariance;
  inflate(observable, factor, &wide);
  const RobustUpdateResult fit = (*robust_update)(robust, &offered, &wide);
  std::size_t kept = 0;
  for (const FilterMeasurement& measurement : offered) kept += measurement.factor > 0.0 ? 1 : 0;
  const double scale = fit.scale[static_cast<std::size_t>(observable)];
  bool agree = scale < suspect && 4 * kept >= 3 * offered.size();
  if (!many)
    agree = agree && redundancy(offered) >= kMinRedundancy && fit.nis < largest_probable(kept);
  return agree ? factor : 1.0;
}

void inflate(Observable observable, double factor, EkfCovariance* covariance) {
  EkfCorrection scale = EkfCorrection::Ones(covariance->rows());
  const double root = std::sqrt(factor);
  if (observable != Observable::kDoppler) {
    scale.segment<3>(kPosition).setConstant(root);
    scale.segment<4>(kClock).setConstant(root);
  } else {
    scale.segment<6>(kVelocity).setConstant(root);
    scale.segment<4>(kClockDrift).setConstant(root);
  }
  covariance->array().colwise() *= scale.array();
  covariance->array().rowwise() *= scale.transpose().array();
}

}  // namespace leonav
