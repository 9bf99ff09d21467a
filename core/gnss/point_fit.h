// The two fits of a point solution: position with clocks from code, velocity with drift from
// Doppler.
#pragma once
#include "core/gnss/measurement.h"
#include "core/gnss/robust_fit.h"

namespace leonav {

struct PositionFit {
  FitResult fit;
  FitState state = FitState::Zero();  // position ECEF, clock offset per system, m
  FitRows rows;
};

// All code measurements of `epoch`, starting at `start_e` (anywhere near the Earth's surface).
void fit_position(const MeasurementEpoch& epoch, const RobustConfig& robust,
                  const Eigen::Vector3d& start_e, PositionFit* result);

struct VelocityFit {
  FitResult fit;
  FitState state = FitState::Zero();  // velocity ECEF, then the drift common to all systems, m/s
  FitRows rows;
};

// All Doppler measurements of `epoch`, at the antenna position `p_a_e`. One drift for all systems:
// the receiver has one oscillator, and system times differ by less than 1e-13.
void fit_velocity(const MeasurementEpoch& epoch, const RobustConfig& robust,
                  const Eigen::Vector3d& p_a_e, VelocityFit* result);

// Somewhere on the Earth's surface below the middle of the satellites: near enough for
// Gauss-Newton even with LEO satellites alone, whose ranges from the Earth's centre would point to
// the wrong one of two solutions.
Eigen::Vector3d surface_below(const MeasurementEpoch& epoch);

}  // namespace leonav
