// This unit prepares the state of the ionosphere for the measurements of an epoch.
#pragma once
#include "core/filter/estimate/state_estimate.h"
#include "core/gnss/measurement/measurement.h"

namespace leonav {

// Moves the zenith ionosphere delay against the step of the modelled one since the last epoch
// (MeasurementEpoch::ionosphere_step_m), and sets the sigma of its process to the root mean square
// of those that the epoch's codes of one frequency state. Call it once per epoch, before the
// measurements are predicted.
void update_ionosphere(const MeasurementEpoch& epoch, StateEstimate* estimate);

}  // namespace leonav
