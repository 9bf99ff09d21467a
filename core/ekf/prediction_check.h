// Tells a wrong prediction from outliers: when the measurements agree with each other but not with
// the prediction, the clock has jumped or the motion model has failed, and rejecting them all would
// be the worst answer.
#pragma once

#include "core/ekf/ekf_state.h"
#include "core/ekf/robust_update.h"

namespace leonav {

// Looks for a shift that all innovations of one observable share: a clock jump (a receiver that
// steps its clock by milliseconds, or a phone's by anything). Returns the shift, 0 if there is
// none. `variance` is that of the median innovation as predicted.
double common_shift(const FilterMeasurements& measurements, Observable observable,
                    const EkfCovariance& covariance);

// Median of |innovation| over its predicted sigma, divided by what it is for normal errors. NaN:
// fewer than four of `observable`.
double consistency_ratio(const FilterMeasurements& measurements, Observable observable,
                         const EkfCovariance& covariance);

// Factor >= 1 on the predicted variance of the innovations of `observable` with which their median
// square would be as expected; 1 while the median standardized innovation is below `suspect`, and 1
// where the measurements do not agree with each other either once the prior is that wide: then most
// of them are bad, and following them would carry the filter away.
double prediction_inflation(const RobustConfig& robust, const FilterMeasurements& measurements,
                            Observable observable, const EkfCovariance& covariance, double suspect,
                            RobustUpdate* robust_update);

// P <- D P D with sqrt(factor) on the states an observable sees first (code, carrier: position,
// clock offsets; Doppler: velocity, attitude, clock drifts): stays positive semidefinite.
void inflate(Observable observable, double factor, EkfCovariance* covariance);

}  // namespace leonav
