// These functions fill an EpochReport: every satellite and every measurement, with its reason.
#pragma once
#include "core/filter/ekf.h"
#include "core/navigator/interface/epoch_report.h"

namespace leonav {

// Clears `report` for an epoch of which nothing is known yet; keeps nothing but the storage.
void start_report(std::uint64_t index, GpsTime time, bool empty, EpochReport* report);

// Satellites, measurements and DOP of an epoch the filter has been updated with.
void report_update(const MeasurementEpoch& epoch, const EkfUpdateResult& result,
                   const Eigen::Vector3d& antenna_p_e, EpochReport* report);

// The same where a point solution, or the attempt at one, took the filter's place. Where `solved`
// is false, what would have been used is reported as kNotSolved.
void report_point(const MeasurementEpoch& epoch, bool solved, const Eigen::Vector3d& antenna_p_e,
                  EpochReport* report);

// The filter's estimate at the epoch: solution (without sequence, source and anchor) and clocks.
void report_state(const Ekf& ekf, EpochReport* report);

}  // namespace leonav
