#include "core/ekf/prediction_check.h"

#include <algorithm>
#include <cmath>

#include "core/ekf/median.h"

namespace leonav {
namespace {

using namespace ekf_index;
using SmallTable = boost::container::static_vector<double, kMaxMeasurements>;

constexpr double kMedianSquare = 0.4549;  // median of a chi-square with one degree of freedom
constexpr double kMaxInflation = 1e6;     // per epoch
constexpr std::size_t kMinRedundant = 7;  // position, clocks, and enough to check them
constexpr std::size_t kMinCount = 4;      // fewer do not outvote a prediction ...
constexpr double kMillisecondStep =
    29'979.0;                          // ... unless off by more than a tenth of a millisecond
constexpr double kShiftRatio = 5.0;    // shift over predicted sigma
constexpr double kSpreadShare = 0.33;  // spread about the shift, as a share of it

}  // namespace

double common_shift(const FilterMeasurements& measurements, Observable observable,
                    const EkfCovariance& covariance) {
  SmallTable innovations, variances;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable != observable) continue;
    innovations.push_back(measurement.innovation);
    variances.push_back(measurement.variance + measurement.row.dot(covariance * measurement.row));
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

double prediction_inflation(const RobustConfig& robust, const FilterMeasurements& measurements,
                            Observable observable, const EkfCovariance& covariance,
                            double suspect) {
  SmallTable ratios, factors;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable != observable) continue;
    const double predicted = measurement.row.dot(covariance * measurement.row);
    const double square = measurement.innovation * measurement.innovation;
    ratios.push_back(square / (predicted + measurement.variance));
    if (predicted > 0.0)
      factors.push_back((square / kMedianSquare - measurement.variance) / predicted);
  }
  if (ratios.size() < kMinRedundant || factors.empty()) return 1.0;
  if (std::sqrt(median(ratios)) < suspect) return 1.0;
  const double factor = std::clamp(median(factors), 1.0, kMaxInflation);

  // Would they agree?
  FilterMeasurements trial;
  for (const FilterMeasurement& measurement : measurements)
    if (measurement.observable == observable) trial.push_back(measurement);
  EkfCovariance wide = covariance;
  inflate(observable, factor, &wide);
  const RobustUpdateResult fit = robust_update(robust, &trial, &wide);
  std::size_t kept = 0;
  for (const FilterMeasurement& measurement : trial) kept += measurement.factor > 0.0 ? 1 : 0;
  const double scale = observable == Observable::kCode ? fit.code_scale : fit.doppler_scale;
  const bool agree = scale < suspect && 4 * kept >= 3 * trial.size();
  return agree ? factor : 1.0;
}

void inflate(Observable observable, double factor, EkfCovariance* covariance) {
  EkfVector scale = EkfVector::Ones();
  const double root = std::sqrt(factor);
  if (observable == Observable::kCode) {
    scale.segment<3>(kPosition).setConstant(root);
    scale.segment<4>(kClock).setConstant(root);
  } else {
    scale.segment<6>(kVelocity).setConstant(root);
    scale.segment<4>(kClockDrift).setConstant(root);
  }
  *covariance = scale.asDiagonal() * (*covariance) * scale.asDiagonal();
}

}  // namespace leonav
