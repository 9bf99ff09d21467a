// This function tells how far an undetected fault of a satellite or of a system, or a missed slip,
// may have moved the position.
#pragma once
#include <Eigen/Core>

#include "core/filter/update/filter_measurement.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/signals/band_plan.h"
#include "core/integrity/fault_hypothesis.h"
#include "core/integrity/integrity_config.h"
#include "core/navigator/monitors/satellite_fault_monitor.h"

namespace leonav {

// A position in ECEF, m, with its covariance, m^2.
struct PositionEstimate {
  Eigen::Vector3d p_e;
  Eigen::Matrix3d covariance_e;
};

// Returns the hypotheses of single satellites, of missed slips and of systems after an update with
// `measurements` of `epoch`, which led to `estimate`. The separation is what the filter has
// followed of the suspect carriers (SatelliteFaultMonitor), times the change of position per metre
// (FaultDirections); its variance is the same with what is usual of all carriers. A missed slip is
// one cycle, of a pair one on both frequencies: c / (f_1 + f_2), the smallest that hides from the
// difference of the two. An arc that was joined to another (Ambiguity::wrong_join_probability) may
// have a wrong join as well. A fault with a probability below 0.005 whose separation, three
// of its sigmas added, is within one sigma of the estimate along every axis is left out: the level
// would hardly rise.
FaultHypotheses satellite_fault_hypotheses(
    const SatelliteFaultMonitor& monitor, const MeasurementEpoch& epoch,
    const FilterMeasurements& measurements, const Ambiguities& ambiguities,
    const PositionEstimate& estimate, const IntegrityConfig& config, const BandPlan& bands = {});

}  // namespace leonav
