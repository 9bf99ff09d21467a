// These functions let the error states of codes and Dopplers in a StateEstimate come and go.
#pragma once
#include "core/filter/estimate/state_estimate.h"
#include "core/gnss/measurement/measurement.h"
#include "core/inertial/strapdown/imu_error_model.h"

namespace leonav {

// Returns the state of the correlated error of `measurement`, a code or Doppler of `satellite`, and
// gives it the process `model`. A new state has the stationary variance. kNoSignalState: no
// capacity.
int find_or_add_signal_error(const Measurement& measurement, SatelliteId satellite,
                             const GaussMarkov& model, GpsTime time, StateEstimate* estimate);

// Removes error states that have no measurement for so long that they know nothing any more, and
// those that began at `time`: their measurements are assembled once more.
void remove_idle_signal_errors(GpsTime time, StateEstimate* estimate);

}  // namespace leonav
