// A measurement as the filter's update sees it.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/filter/state/ekf_state.h"
#include "core/gnss/measurement/measurement.h"

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
  int code_weighting_entry = -1;  // a code's place in ColoredCodeWeighting; -1: none
  int ambiguity = -1;             // state of its ambiguity, whose coefficient is one; -1: none
  double factor = 1.0;            // out: IGG-III
};

using FilterMeasurements = boost::container::static_vector<FilterMeasurement, kMaxMeasurements>;

// H P H^T of one measurement.
double predicted_variance(const FilterMeasurement& measurement, const EkfCovariance& covariance);

}  // namespace leonav
