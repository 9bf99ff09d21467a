// Innovations without what all of a kind have in common: a clock that nobody can predict would hide
// what the prediction of the position is off.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/filter/state/ekf_state.h"
#include "core/filter/update/robust_update.h"

namespace leonav {

struct ClockRemovedInnovation {
  std::size_t index = 0;  // into the measurements
  double innovation = 0.0;
  double variance = 0.0;           // of what is left: measured and predicted
  double measured_variance = 0.0;  // the measurement's own
};
using ClockRemovedInnovations =
    boost::container::static_vector<ClockRemovedInnovation, kMaxMeasurements>;

// An ambiguity of this variance or more, m^2, is as good as unknown: one that begins at this epoch.
inline constexpr double kUnknownAmbiguityVariance = 1e4;

// Those of one observable. Each time base with four of them or more is free of its own clock: a
// step of one is then no wrong position. What the others have goes with the largest base, or, where
// no base has four, they all go together. Carriers whose ambiguity is as good as unknown are left
// out: they agree with everything.
ClockRemovedInnovations clock_removed_innovations(const FilterMeasurements& measurements,
                                                  Observable observable,
                                                  const EkfCovariance& covariance);

}  // namespace leonav
