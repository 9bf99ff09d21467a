// RobustUpdate applies the measurements of one epoch to a covariance, with IGG-III weights.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/filter/state/ekf_state.h"
#include "core/filter/update/filter_measurement.h"
#include "core/filter/update/internal/weighted_least_squares.h"
#include "core/robust/igg3.h"

namespace leonav {

inline constexpr std::size_t kObservables = 3;

struct RobustUpdateResult {
  EkfCorrection correction;
  double nis = 0.0;
  // Per Observable: median residual over its expected value, at least 1.
  std::array<double, kObservables> scale = {1.0, 1.0, 1.0};
  // Per Observable: the factor by which the sigmas of measurements that contradict each other were
  // raised.
  std::array<double, kObservables> sigma_inflation = {1.0, 1.0, 1.0};
};

// IGG-III: core/robust/igg3.h. Allocates its tables when constructed, not after.
class RobustUpdate {
 public:
  // Weighs and solves at most `config.max_iterations` times, and writes `factor` of every
  // measurement and the covariance after the update. The rules:
  // 1. The tested residual is that against the prediction from the prior and all *other*
  //    measurements, over its standard deviation. In the first pass, when none is used yet, this is
  //    the standardized innovation; afterwards it also finds outliers that a poor prior hides.
  // 2. What the innovation test excludes stays excluded. Whether the prior is wrong was decided
  //    before (core/filter/prediction_test.h).
  // 3. If the median residual of an observable is larger than it should be, all its residuals are
  //    scaled down first, so that the many are not excluded for the sake of the few.
  // 4. If that scale still exceeds three at the end, codes or Dopplers contradict each other: their
  //    variances are multiplied by its square and all are weighed again.
  // 5. Carriers whose weights do not converge are excluded worst first. If fewer than three
  //    quarters of them remain, or if the codes contradict each other as well, no carrier is used:
  //    any four agree about some position.
  RobustUpdateResult operator()(const RobustConfig& config, FilterMeasurements* measurements,
                                EkfCovariance* covariance);

 private:
  using FactorLimits = boost::container::static_vector<double, kMaxMeasurements>;
  // `worst_excluded`: rule 5 has been applied.
  void weigh(const RobustConfig& config, FactorLimits* limits, bool* worst_excluded,
             FilterMeasurements* measurements, RobustUpdateResult* result);
  void exclude_worst_first(const RobustConfig& config, const RobustUpdateResult& weighed,
                           FactorLimits* limits, FilterMeasurements* measurements);
  void weigh_with_inflated_sigmas(const RobustConfig& config, FactorLimits* limits,
                                  FilterMeasurements* measurements, RobustUpdateResult* result);

  WeightedLeastSquares least_squares_;
};

}  // namespace leonav
