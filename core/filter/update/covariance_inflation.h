// This function inflates the covariance of a prediction that has proved wrong.
#pragma once
#include "core/filter/state/ekf_state.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav {

// Adds `variance` to the states that an observable measures directly: position and clock offsets
// for code and carrier, velocity and clock drifts for Doppler. States without variance stay (the
// velocity of a fixed point, the clock of an unobserved system). The variance is added, not
// multiplied, because nearly perfect correlations with ambiguities would turn a scaled prior into a
// better one. A velocity (drift) that went wrong evenly over `interval_s` has moved the position
// (offset) by half the product, which is added as well, without correlation.
void inflate_covariance(Observable observable, double variance, double interval_s,
                        EkfCovariance* covariance);

}  // namespace leonav
