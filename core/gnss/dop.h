// Dilution of precision: how the geometry alone turns range errors into position errors.
#pragma once
#include <Eigen/Core>
#include <bitset>

#include "core/gnss/measurement.h"

namespace leonav {

struct Dop {
  double pdop = 0.0;
  double hdop = 0.0;
  double vdop = 0.0;
  // Root of the trace of the whole cofactor matrix: position and the clock of every system in use.
  double gdop = 0.0;
};

// Of the satellites with a code measurement in use (kUsed or kDownweighted), one row each, all of
// unit weight, one clock per system, seen from the antenna at `p_a_e`. All NaN where the geometry
// does not determine a position.
Dop dilution_of_precision(const MeasurementEpoch& epoch, const Eigen::Vector3d& p_a_e);

// The same of the satellites that `used` says, by their place in epoch.satellites.
Dop dilution_of_precision(const MeasurementEpoch& epoch, const std::bitset<kMaxSatellites>& used,
                          const Eigen::Vector3d& p_a_e);

}  // namespace leonav
