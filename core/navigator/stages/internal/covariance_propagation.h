// The covariance of an anchor is propagated to the present here, in closed form.
#pragma once
#include "core/inertial/strapdown/imu_error_model.h"
#include "core/navigator/interface/solution_conversion.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

// Covariance of position, velocity, attitude `elapsed_s` after `anchor`, for a mean specific force
// `f_e` (m/s^2, ECEF) since then and the present attitude. Biases are taken as constant, the noise
// as white: over the second or so between anchors that is the filter's own prediction to a few per
// cent, at the cost of one 9x15 product instead of one per sample.
PvaCovariance inertial_covariance(const Anchor& anchor, const ImuErrorModel& imu,
                                  const Eigen::Vector3d& f_e, const Eigen::Matrix3d& C_eb,
                                  double elapsed_s);

// The same without attitude: constant velocity, driven by white acceleration of the given density
// in (m/s^2)/sqrt(Hz).
PvaCovariance constant_velocity_covariance(const Anchor& anchor, double acceleration_noise,
                                           double elapsed_s);

// Adds `elapsed_s` of white acceleration to a covariance.
void add_acceleration_noise(double acceleration_noise, double elapsed_s, PvaCovariance* covariance);

}  // namespace leonav
