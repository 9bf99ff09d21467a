// This unit computes the dilution of precision: how the geometry alone turns range errors into
// position errors. The values are roots of traces of the cofactor matrix (H^T H)^-1 with unit
// weights.
#pragma once
#include <Eigen/Core>
#include <bitset>

#include "core/gnss/measurement/measurement.h"

namespace leonav {

// Dilutions of precision, dimensionless.
struct Dop {
  double pdop = 0.0;
  double hdop = 0.0;
  double vdop = 0.0;
  // Root of the trace of the whole cofactor matrix: position and the clocks of all systems in use.
  double gdop = 0.0;
};

// Computes the DOP of the satellites with a code measurement in use (kUsed or kDownweighted), seen
// from the antenna at `p_a_e` (ECEF, m): one row per satellite, unit weights, one clock per system.
// All values are NaN where the geometry does not determine a position.
Dop dilution_of_precision(const MeasurementEpoch& epoch, const Eigen::Vector3d& p_a_e);

// Computes the DOP of the satellites whose bit in `used` is set, by their index in
// epoch.satellites.
Dop dilution_of_precision(const MeasurementEpoch& epoch, const std::bitset<kMaxSatellites>& used,
                          const Eigen::Vector3d& p_a_e);

}  // namespace leonav
