// FilterMeasurement is one scalar measurement on its way through the filter's update.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/filter/state/ekf_state.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav {

struct FilterMeasurement {
  std::size_t index = 0;  // into MeasurementEpoch::measurements
  Observable observable = Observable::kCode;
  double innovation = 0.0;
  double variance = 0.0;       // of the measurement alone, for the outlier test
  double gain_variance = 0.0;  // the same with its correlation in time, for the gain
  // That correlation: the share of the variance that is correlated, and its time.
  double correlated_share = 0.0, correlation_time_s = 1.0;
  EkfVector row = EkfVector::Zero();
  // |innovation| over its sigma with the clocks removed (prediction_consistency.h), tested beside
  // the plain one before anything is used.
  double prior_ratio = 0.0;
  int code_weighting_entry = -1;  // a code's index in ColoredCodeWeighting; -1: none
  int ambiguity = -1;             // index of its ambiguity state (coefficient one); -1: none
  double factor = 1.0;            // out: IGG-III
};

using FilterMeasurements = boost::container::static_vector<FilterMeasurement, kMaxMeasurements>;

// Returns H P H^T of one measurement.
double predicted_variance(const FilterMeasurement& measurement, const EkfCovariance& covariance);

}  // namespace leonav
