// This function tells how far an undetected fault of a satellite or of a system may have moved the
// position.
#pragma once
#include "core/filter/ekf.h"
#include "core/integrity/fault_hypothesis.h"
#include "core/integrity/integrity_config.h"
#include "core/navigator/monitors/satellite_fault_monitor.h"

namespace leonav {

// Returns the hypotheses of single satellites and of systems after the update with `epoch`. The
// separation is what the filter has followed of the suspect carriers (SatelliteFaultMonitor), times
// the change of position per metre (FaultDirections); its variance is the same with what is usual
// of all carriers. A fault whose separation is within one sigma of the filter in every direction
// raises no level, and is left out.
FaultHypotheses satellite_fault_hypotheses(const SatelliteFaultMonitor& monitor,
                                           const MeasurementEpoch& epoch, const Ekf& filter,
                                           const IntegrityConfig& config);

}  // namespace leonav
