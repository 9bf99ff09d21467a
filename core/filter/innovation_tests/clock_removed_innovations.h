// This header removes the receiver clock from innovations, because an unpredictable clock would
// hide an error of the predicted position.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/filter/state/ekf_state.h"
#include "core/filter/update/robust_update.h"

namespace leonav {

struct ClockRemovedInnovation {
  std::size_t index = 0;  // into the measurements
  double innovation = 0.0;
  double variance = 0.0;           // of `innovation`: measured and predicted
  double measured_variance = 0.0;  // of the measurement alone
};
using ClockRemovedInnovations =
    boost::container::static_vector<ClockRemovedInnovation, kMaxMeasurements>;

// An ambiguity with this variance or more, m^2, counts as unknown: its arc begins at this epoch.
inline constexpr double kUnknownAmbiguityVariance = 1e4;

// Returns the clock-removed innovations of one observable. Each system with four or more of them
// has its own median removed, so that a step of its clock does not look like a wrong position. The
// others share the clock of the largest system or, where no system has four, one clock for all.
// Carriers with an unknown ambiguity are left out, because they agree with everything.
ClockRemovedInnovations clock_removed_innovations(const FilterMeasurements& measurements,
                                                  Observable observable,
                                                  const EkfCovariance& covariance);

}  // namespace leonav
