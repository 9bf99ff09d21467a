// These functions propagate the covariance of an anchor to the present, in closed form.
//
// Formulas: docs/models/navigator.md; Groves 2013, 14.2.3.
#pragma once
#include "core/inertial/strapdown/imu_error_model.h"
#include "core/navigator/interface/solution_conversion.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

// Returns the covariance of position, velocity and attitude `elapsed_s` after `anchor`, for the
// mean specific force `f_e` (m/s^2, ECEF) since then and the present attitude `C_eb`. Biases are
// constant and the noise is white. Over the second or so between anchors this agrees with the
// filter's own prediction to a few per cent, at the cost of one 9x15 product instead of one per
// sample.
PvaCovariance inertial_covariance(const Anchor& anchor, const ImuErrorModel& imu,
                                  const Eigen::Vector3d& f_e, const Eigen::Matrix3d& C_eb,
                                  double elapsed_s);

// Returns the covariance without attitude: constant velocity, driven by white acceleration of
// density `acceleration_noise` in (m/s^2)/sqrt(Hz).
PvaCovariance constant_velocity_covariance(const Anchor& anchor, double acceleration_noise,
                                           double elapsed_s);

// Adds the effect of white acceleration over `elapsed_s` to position and velocity.
void add_acceleration_noise(double acceleration_noise, double elapsed_s, PvaCovariance* covariance);

}  // namespace leonav
