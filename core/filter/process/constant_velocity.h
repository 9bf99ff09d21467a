// Position and velocity driven by white acceleration: the model without an IMU, and over its holes.
#pragma once
#include "core/filter/state/ekf_state.h"

namespace leonav {

// P <- Phi P Phi^T + Q over `dt` seconds with the acceleration's spectral densities
// (m/s^2)/sqrt(Hz) in the horizontal plane and along the vertical of `p_e`. Exact for any dt >= 0.
void propagate_constant_velocity(const Eigen::Vector3d& p_e, double horizontal, double vertical,
                                 double dt, EkfCovariance* covariance);

}  // namespace leonav
