// This is the constant-velocity model: position and velocity driven by white acceleration.
#pragma once
#include "core/filter/state/ekf_state.h"

namespace leonav {

// Applies P <- Phi P Phi^T + Q over `dt` seconds, with spectral densities of the acceleration in
// (m/s^2)/sqrt(Hz) in the horizontal plane and along the vertical at `p_e` (ECEF, m). Exact for any
// dt >= 0 (Bar-Shalom, Li and Kirubarajan 2001, 6.2.2).
void propagate_constant_velocity(const Eigen::Vector3d& p_e, double horizontal, double vertical,
                                 double dt, EkfCovariance* covariance);

}  // namespace leonav
