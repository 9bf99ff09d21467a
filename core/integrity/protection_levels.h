// This function computes horizontal, vertical and heading protection level of one estimate.
//
// The horizontal error is bounded along the two axes of its nominal error ellipse, each with half
// of the risk; the level is the root of the sum of the two squares, as in ARAIM.
#pragma once
#include <Eigen/Core>
#include <limits>
#include <span>

#include "core/integrity/fault_hypothesis.h"
#include "core/integrity/integrity_config.h"

namespace leonav {

// The error of an estimate without a fault. North, east, down.
struct NominalError {
  Eigen::Matrix3d position_covariance_n = Eigen::Matrix3d::Zero();  // m^2
  // Bounds of errors that do not average out, m.
  Eigen::Vector3d position_bias_n = Eigen::Vector3d::Zero();
  double heading_variance = std::numeric_limits<double>::quiet_NaN();  // rad^2; NaN: no heading
};

// The levels that the errors exceed with the configured risk at most; NaN: none is known.
struct ProtectionLevels {
  double horizontal_m = std::numeric_limits<double>::quiet_NaN();
  double vertical_m = std::numeric_limits<double>::quiet_NaN();
  double heading = std::numeric_limits<double>::quiet_NaN();  // rad, at most pi
};

// Returns the levels at the configured risk, each for itself.
ProtectionLevels protection_levels(const NominalError& nominal,
                                   std::span<const FaultHypothesis> hypotheses,
                                   const IntegrityConfig& config);

}  // namespace leonav
