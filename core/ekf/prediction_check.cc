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

constexpr double kMedianSquare = 0.4549;   // median of a chi-square with one degree of freedom
constexpr double kUnknownAmbiguity = 1e4;  // m^2
constexpr double kAgreeScale = 1.5;    // residuals of measurements that agree, over their sigmas
constexpr double kMaxMissing = 1e12;   // m^2 or (m/s)^2, per epoch
constexpr int kMinRedundancy = 2;      // beyond position and clocks: enough to check them
constexpr std::size_t kManyCount = 7;  // or so many, whatever their clocks
constexpr std::size_t kMinCount = 4;   // fewer do not outvote a prediction ...
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

// H_a P H_b^T of two measurements.
double predicted_covariance(const FilterMeasurement& a, const FilterMeasurement& b,
                            const EkfCovariance& P) {
  double covariance = a.row.dot(P.topLeftCorner<kSize, kSize>() * b.row);
  if (a.ambiguity >= 0) covariance += P.col(a.ambiguity).head<kSize>().dot(b.row);
  if (b.ambiguity >= 0) covariance += P.col(b.ambiguity).head<kSize>().dot(a.row);
  if (a.ambiguity >= 0 && b.ambiguity >= 0) covariance += P(a.ambiguity, b.ambiguity);
  return covariance;
}

// Innovations with what all have in common taken out: a clock that nobody can predict would hide
// what the prediction of the position is off. `variance`: of what is left.
struct ClockFree {
  std::size_t index = 0;  // into the measurements
  double innovation = 0.0, variance = 0.0, measured_variance = 0.0;
};
using ClockFreeTable = boost::container::static_vector<ClockFree, kMaxMeasurements>;

// Less the median, and its row less the mean row.
void take_out_median(const FilterMeasurements& measurements, const EkfCovariance& covariance,
                     ClockFreeTable* table) {
  SmallTable innovations;
  EkfVector shared = EkfVector::Zero();
  for (const ClockFree& entry : *table) {
    innovations.push_back(entry.innovation);
    shared += measurements[entry.index].row / static_cast<double>(table->size());
  }
  const double middle = median(innovations);
  for (ClockFree& entry : *table) {
    FilterMeasurement relative = measurements[entry.index];
    relative.row.segment<8>(kClock) -= shared.segment<8>(kClock);
    entry.innovation -= middle;
    entry.variance =
        entry.measured_variance + std::max(predicted_variance(relative, covariance), 0.0);
  }
}

// Less the one in the middle: their ambiguities too have much in common.
void take_out_middle_one(const FilterMeasurements& measurements, const EkfCovariance& covariance,
                         ClockFreeTable* table) {
  ClockFreeTable sorted = *table;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(
      sorted.begin(), middle, sorted.end(), [](const ClockFree& a, const ClockFree& b) {
        return a.innovation != b.innovation ? a.innovation < b.innovation : a.index < b.index;
      });
  const FilterMeasurement& reference = measurements[middle->index];
  const double of_reference = predicted_covariance(reference, reference, covariance);
  for (ClockFree& entry : *table) {
    const FilterMeasurement& m = measurements[entry.index];
    entry.innovation -= reference.innovation;
    entry.variance = m.variance + reference.variance +
                     std::max(predicted_covariance(m, m, covariance) + of_reference -
                                  2.0 * predicted_covariance(m, reference, covariance),
                              0.0);
  }
}

// Carriers whose ambiguity is as good as unknown are left out: they agree with everything.
ClockFreeTable clock_free(const FilterMeasurements& measurements, Observable observable,
                          const EkfCovariance& covariance) {
  ClockFreeTable table;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const FilterMeasurement& m = measurements[i];
    if (m.observable != observable) continue;
    if (m.ambiguity >= 0 && covariance(m.ambiguity, m.ambiguity) >= kUnknownAmbiguity) continue;
    table.push_back({i, m.innovation, 0.0, m.variance});
  }
  if (table.empty()) return table;
  if (observable == Observable::kCarrier)
    take_out_middle_one(measurements, covariance, &table);
  else
    take_out_median(measurements, covariance, &table);
  return table;
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
  for (const ClockFree& entry : clock_free(measurements, observable, covariance))
    ratios.push_back(std::abs(entry.innovation) / std::sqrt(entry.variance));
  if (ratios.size() < kMinCount) return std::numeric_limits<double>::quiet_NaN();
  return median(ratios) / std::sqrt(kMedianSquare);
}

void set_prior_ratios(const EkfCovariance& covariance, FilterMeasurements* measurements) {
  for (const Observable observable : {Observable::kCode, Observable::kCarrier}) {
    const ClockFreeTable table = clock_free(*measurements, observable, covariance);
    if (table.size() < kMinCount) continue;
    for (const ClockFree& entry : table)
      (*measurements)[entry.index].prior_ratio =
          std::abs(entry.innovation) / std::sqrt(entry.variance);
  }
}

double missing_variance(const RobustConfig& robust, const FilterMeasurements& measurements,
                        Observable observable, const EkfCovariance& covariance, double suspect,
                        RobustUpdate* robust_update) {
  const double ratio = consistency_ratio(measurements, observable, covariance);
  if (!(ratio * std::sqrt(kMedianSquare) >= suspect)) return 0.0;
  FilterMeasurements offered;
  for (const FilterMeasurement& measurement : measurements) {
    if (measurement.observable != observable) continue;
    offered.push_back(measurement);
    offered.back().factor = 1.0;
  }
  const bool many = offered.size() >= kManyCount;
  if (!many && redundancy(offered) < kMinRedundancy) return 0.0;
  SmallTable missing;
  for (const ClockFree& entry : clock_free(measurements, observable, covariance))
    missing.push_back(std::pow(entry.innovation, 2) / kMedianSquare - entry.measured_variance);
  // Twice: along a line of sight, and less what the satellites share, only part of it is seen.
  const double variance = std::clamp(2.0 * median(missing), 0.0, kMaxMissing);

  // Few measurements are soon fitted: they are tested as if nothing stayed alike in time.
  if (!many)
    for (FilterMeasurement& measurement : offered) measurement.gain_variance = measurement.variance;
  // Would they agree?
  EkfCovariance wide = covariance;
  widen(observable, variance, &wide);
  const RobustUpdateResult fit = (*robust_update)(robust, &offered, &wide);
  std::size_t kept = 0;
  for (const FilterMeasurement& measurement : offered) kept += measurement.factor > 0.0 ? 1 : 0;
  const double scale = fit.scale[static_cast<std::size_t>(observable)];
  // Few have their sum of squares for it, the median of few being worth little.
  bool agree = scale < (many ? kAgreeScale : suspect) && 4 * kept >= 3 * offered.size();
  if (!many)
    agree = agree && redundancy(offered) >= kMinRedundancy && fit.nis < largest_probable(kept);
  return agree ? variance : 0.0;
}

void widen(Observable observable, double variance, EkfCovariance* covariance) {
  const bool rates = observable == Observable::kDoppler;
  const auto add = [&](int first, int count) {
    for (double& state : covariance->diagonal().segment(first, count))
      if (state > 0.0) state += variance;
  };
  add(rates ? kVelocity : kPosition, 3);
  add(rates ? kClockDrift : kClock, static_cast<int>(kMaxTimeBases));
}

}  // namespace leonav
