// One epoch's measurement update with IGG-III weights.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <memory>

#include "core/ekf/ekf_state.h"
#include "core/gnss/igg3.h"
#include "core/gnss/measurement.h"

namespace leonav {

// One scalar measurement on its way through the update.
struct FilterMeasurement {
  std::size_t index = 0;  // into MeasurementEpoch::measurements
  Observable observable = Observable::kCode;
  double innovation = 0.0;
  double variance = 0.0;       // of the measurement alone: what it is tested against
  double gain_variance = 0.0;  // likewise, with its correlation in time: what it weighs
  EkfVector row = EkfVector::Zero();
  // |innovation| over its sigma with the clocks taken out (prediction_check.h), tested beside the
  // plain one before anything is used.
  double prior_ratio = 0.0;
  int schedule = -1;    // a code's place in CodeSchedule; -1: none
  int ambiguity = -1;   // state of its ambiguity, whose coefficient is one; -1: none
  double factor = 1.0;  // out: IGG-III
};

using FilterMeasurements = boost::container::static_vector<FilterMeasurement, kMaxMeasurements>;

// H P H^T of one measurement.
double predicted_variance(const FilterMeasurement& measurement, const EkfCovariance& covariance);

inline constexpr std::size_t kObservables = 3;

struct RobustUpdateResult {
  EkfCorrection correction;
  double nis = 0.0;
  // Per Observable: by how much the residuals are larger than they should be, from their median;
  // 1 if they are not.
  std::array<double, kObservables> scale = {1.0, 1.0, 1.0};
};

// The tables of one update. Allocates when constructed, not after.
class RobustUpdate {
 public:
  RobustUpdate();
  ~RobustUpdate();
  RobustUpdate(RobustUpdate&&) noexcept;
  RobustUpdate& operator=(RobustUpdate&&) noexcept;

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
  //
  // The update is done in the square root of P (P = L L^T, P+ = L (I + L^T H^T R^-1 H L)^-1 L^T):
  // like Joseph's form symmetric and positive semidefinite whatever the rounding, and states with
  // zero variance stay untouched. (Bierman, Factorization Methods for Discrete Sequential
  // Estimation, 1977, ch. 5.)
  RobustUpdateResult operator()(const RobustConfig& config, FilterMeasurements* measurements,
                                EkfCovariance* covariance);

 private:
  struct Workspace;
  using FactorLimits = boost::container::static_vector<double, kMaxMeasurements>;
  void weigh(const RobustConfig& config, FactorLimits* limits, FilterMeasurements* measurements,
             RobustUpdateResult* result);
  void throw_out_worst_first(const RobustConfig& config, const RobustUpdateResult& weighed,
                             FactorLimits* limits, FilterMeasurements* measurements);
  std::unique_ptr<Workspace> workspace_;
  bool settled_ = false;  // the worst of this epoch have been thrown out
};

}  // namespace leonav
