// One epoch's measurement update with IGG-III weights.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <memory>

#include "core/filter/state/ekf_state.h"
#include "core/filter/update/filter_measurement.h"
#include "core/filter/update/internal/weighted_least_squares.h"
#include "core/robust/igg3.h"

namespace leonav {

inline constexpr std::size_t kObservables = 3;

struct RobustUpdateResult {
  EkfCorrection correction;
  double nis = 0.0;
  // Per Observable: by how much the residuals are larger than they should be, from their median;
  // 1 if they are not.
  std::array<double, kObservables> scale = {1.0, 1.0, 1.0};
  // Likewise by how much the sigmas of measurements that contradict each other have been raised.
  std::array<double, kObservables> sigma_inflation = {1.0, 1.0, 1.0};
};

// The tables of one update. Allocates when constructed, not after.
class RobustUpdate {
 public:
  // Re-weights and solves at most `config.max_iterations` times. The residual that is tested is
  // that against the prediction from all *other* measurements and the prior, over its standard
  // deviation: in the first pass (nothing used yet) that is the standardized innovation, afterwards
  // it also sees outliers that hide behind a poor prior. What the innovation test excludes stays
  // out (whether the prior is to be believed is decided before, prediction_check.h). Where half of
  // the residuals of an observable are larger than they should be, all are scaled down first, so
  // that the many are not thrown out for the few; where they still are more than three times as
  // large in the end, codes or Dopplers contradict each other, and their variances grow by as much
  // before all are weighted anew: `factor` then holds what is left of each one's weight.
  // Carriers that contradict so much that the weights go to and fro are thrown out worst first;
  // where fewer than three quarters of them are left by that, or beside codes that contradict each
  // other, none is used: any four agree about some position.
  RobustUpdateResult operator()(const RobustConfig& config, FilterMeasurements* measurements,
                                EkfCovariance* covariance);

 private:
  using FactorLimits = boost::container::static_vector<double, kMaxMeasurements>;
  void weigh(const RobustConfig& config, FactorLimits* limits, FilterMeasurements* measurements,
             RobustUpdateResult* result);
  void exclude_worst_first(const RobustConfig& config, const RobustUpdateResult& weighed,
                           FactorLimits* limits, FilterMeasurements* measurements);
  void weigh_with_inflated_sigmas(const RobustConfig& config, FactorLimits* limits,
                                  FilterMeasurements* measurements, RobustUpdateResult* result);

  WeightedLeastSquares least_squares_;
  bool worst_excluded_ = false;  // the worst of this epoch have been thrown out
};

}  // namespace leonav
