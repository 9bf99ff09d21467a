// Tells a wrong prediction from outliers: when the measurements agree with each other but not with
// the prediction, the clock has jumped or the motion model has failed, and rejecting them all would
// be the worst answer.
#pragma once

#include "core/filter/innovation_tests/clock_removed_innovations.h"
#include "core/filter/state/ekf_state.h"
#include "core/filter/update/robust_update.h"

namespace leonav {

// Looks for a shift that all innovations of one observable share: a clock jump (a receiver that
// steps its clock by milliseconds, or a phone's by anything). Returns the shift, 0 if there is
// none.
double common_shift(const FilterMeasurements& measurements, Observable observable,
                    const EkfCovariance& covariance);

// Median of |innovation| over its sigma, divided by what it is for normal errors. NaN: fewer than
// four.
double consistency_ratio(const ClockRemovedInnovations& table);

// Whether the median standardized innovation is below `suspect`; false for fewer than four.
bool median_is_consistent(const ClockRemovedInnovations& table, double suspect);

// Whether all standardized innovations are below three.
bool all_are_consistent(const ClockRemovedInnovations& table);

// Sets prior_ratio of the table's measurements, where there are four: a clock whose prediction is
// worth nothing would let all of them pass, whatever they contradict.
void set_prior_ratios(const ClockRemovedInnovations& table, FilterMeasurements* measurements);

// Variance by which the predicted position (of Dopplers: velocity), along each axis, is wrong
// beyond its covariance; 0 while the median standardized innovation is below `suspect`, and 0 where
// the measurements do not agree with each other either once the prior is that wide: then most of
// them are bad, and following them would carry the filter away. `table`: of `observable`.
double unmodelled_prior_variance(const RobustConfig& robust, const FilterMeasurements& measurements,
                                 Observable observable, const ClockRemovedInnovations& table,
                                 const EkfCovariance& covariance, double suspect,
                                 RobustUpdate* robust_update);

// Adds `variance` to the states an observable sees first (code, carrier: position, clock offsets;
// Doppler: velocity, clock drifts) and that are states at all: a fixed point has no velocity, a
// time base none has seen no clock. Added, not scaled: correlations with ambiguities that are
// nearly perfect would turn a wider prior into a better one. A velocity (a drift) that has gone
// wrong over `interval_s`, evenly, has taken the position (the clock) with it: by half of the way,
// which is added as well (without the correlation: what came of it is the ranges' to say).
void inflate_covariance(Observable observable, double variance, double interval_s,
                        EkfCovariance* covariance);

}  // namespace leonav
