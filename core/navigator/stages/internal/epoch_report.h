// These functions fill an EpochReport: every satellite and every measurement, with its reason.
#pragma once
#include "core/filter/ekf.h"
#include "core/integrity/level_growth.h"
#include "core/navigator/interface/epoch_report.h"

namespace leonav {

// Clears `report` for a new epoch and keeps only its storage.
void start_report(std::uint64_t index, GpsTime time, bool empty, EpochReport* report);

// Reports satellites, measurements and DOP of an epoch with which the filter was updated.
void report_update(const MeasurementEpoch& epoch, const EkfUpdateResult& result,
                   const Eigen::Vector3d& antenna_p_e, EpochReport* report);

// Reports the same for an epoch with a point solution, or an attempt at one, instead of an update.
// If `solved` is false, measurements that would have been used get the reason kNotSolved.
void report_point(const MeasurementEpoch& epoch, bool solved, const Eigen::Vector3d& antenna_p_e,
                  EpochReport* report);

// Reports the filter's estimate at the epoch: clocks, wet delay, and the solution without sequence,
// source and anchor.
void report_state(const Ekf& ekf, EpochReport* report);

// Adds the protection levels to a reported estimate of the filter, for the fault hypotheses of the
// report. Returns the levels from this epoch on; without estimate there are none.
LevelGrowth report_levels(const Ekf& ekf, const IntegrityConfig& config, EpochReport* report);

}  // namespace leonav
