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
  // Of the measurement alone, without its signal state, for the outlier test.
  double variance = 0.0;
  double marginal_variance = 0.0;  // the same with the correlated error
  double gain_variance = 0.0;      // the same with its correlation in time, for the gain
  EkfVector row = EkfVector::Zero();
  // |innovation| over its sigma with the clocks removed (prediction_consistency.h), tested beside
  // the plain one before anything is used.
  double prior_ratio = 0.0;
  int code_weighting_entry = -1;  // a code's index in ColoredCodeWeighting; -1: none
  // Index of its signal state (coefficient one): the ambiguity of a carrier, the correlated error
  // of a code or Doppler; -1: none.
  int signal_state = -1;
  double factor = 1.0;  // out: IGG-III
};

using FilterMeasurements = boost::container::static_vector<FilterMeasurement, kMaxMeasurements>;

// Returns the variance of a measurement's error, with what is known of its correlated part; of a
// carrier without the ambiguity.
double error_variance(const FilterMeasurement& measurement, const EkfCovariance& covariance);

// Returns H P H^T of one measurement.
double predicted_variance(const FilterMeasurement& measurement, const EkfCovariance& covariance);

}  // namespace leonav
