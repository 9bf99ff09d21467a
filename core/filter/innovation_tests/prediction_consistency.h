// These functions distinguish a wrong prediction from outliers. Measurements that agree with each
// other but not with the prediction show that the clock has jumped or the motion model has failed;
// rejecting them all would be the worst answer.
#pragma once

#include "core/filter/innovation_tests/clock_removed_innovations.h"
#include "core/filter/state/ekf_state.h"
#include "core/filter/update/robust_update.h"

namespace leonav {

// Returns the median innovation of one observable if it is a shift that they share
// (two_thirds_share(), and a small scatter), otherwise 0: a clock jump (a receiver's by
// milliseconds, a phone's by anything), m.
double common_shift(const FilterMeasurements& measurements, Observable observable,
                    const EkfCovariance& covariance);

// Returns the median of |innovation| over its sigma, divided by its value for normal errors
// (0.674); NaN for fewer than four.
double consistency_ratio(const ClockRemovedInnovations& table);

// Returns true if the median standardized innovation is below `suspect`; false for fewer than four.
bool median_is_consistent(const ClockRemovedInnovations& table, double suspect);

// Returns true if all standardized innovations are below three.
bool all_are_consistent(const ClockRemovedInnovations& table);

// Sets prior_ratio of the table's measurements if there are four or more: with an unpredictable
// clock, all of them would pass the plain innovation test.
void set_prior_ratios(const ClockRemovedInnovations& table, FilterMeasurements* measurements);

// Returns the variance, per axis, by which the predicted position (for Dopplers: velocity) is wrong
// beyond its covariance, m^2 or (m/s)^2. It is 0 while the median standardized innovation is below
// `suspect`, and 0 if the measurements do not agree with each other even with so wide a prior: then
// most of them are bad, and the filter must not follow them. `table`: of `observable`.
double unmodelled_prior_variance(const RobustConfig& robust, const FilterMeasurements& measurements,
                                 Observable observable, const ClockRemovedInnovations& table,
                                 const EkfCovariance& covariance, double suspect,
                                 RobustUpdate* robust_update);

}  // namespace leonav
