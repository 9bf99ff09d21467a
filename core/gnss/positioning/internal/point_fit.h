// This unit makes the two fits of a point solution: position with clocks from codes, velocity with
// drift from Dopplers.
#pragma once
#include "core/gnss/measurement/measurement.h"
#include "core/robust/robust_fit.h"

namespace leonav {

// Fit of the position with a clock per system.
struct PositionFit {
  FitResult fit;
  FitState state = FitState::Zero();  // position ECEF, clock offset per system, m
  FitRows rows;
};

// Fits all code measurements of `epoch`, starting at `start_e` (anywhere near the Earth's surface).
void fit_position(const MeasurementEpoch& epoch, const RobustConfig& robust,
                  const Eigen::Vector3d& start_e, PositionFit* result);

// Fit of the velocity with one drift.
struct VelocityFit {
  FitResult fit;
  FitState state = FitState::Zero();  // velocity ECEF, then the drift common to all systems, m/s
  FitRows rows;
};

// Fits all Doppler measurements of `epoch` at the antenna position `p_a_e` (ECEF, m). All systems
// share one drift: the receiver has one oscillator, and system times differ by less than 1e-13.
void fit_velocity(const MeasurementEpoch& epoch, const RobustConfig& robust,
                  const Eigen::Vector3d& p_a_e, VelocityFit* result);

// Returns a point on the Earth's surface below the middle of the satellites. It is near enough for
// Gauss-Newton even with LEO satellites alone, whose ranges seen from the Earth's centre would lead
// to the wrong one of two solutions.
Eigen::Vector3d surface_below(const MeasurementEpoch& epoch);

}  // namespace leonav
