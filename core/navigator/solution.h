// From an inertial state and its covariance in ECEF to what is published: geodetic,
// north-east-down.
#pragma once
#include <Eigen/Core>

#include "core/navigator/outputs.h"

namespace leonav {

// Covariance of position, velocity and attitude errors in ECEF, in the order of ekf_index.
using PvaCovariance = Eigen::Matrix<double, 9, 9>;

// The position at the stamp of a state that is of `time_offset_s` later; what else changes in these
// milliseconds is left as it is.
NavState at_stamp(const NavState& state, double time_offset_s);

// Fills time, position, velocity, attitude, their sigmas and the IMU errors; leaves the rest of
// `solution` (sequence, source, anchor, jump) to the caller. Without attitude the angles and their
// sigmas are zero.
void fill_solution(const NavState& state, const PvaCovariance& covariance, bool has_attitude,
                   Solution* solution);

// Root of the sum of the variances; NaN where the covariance is no number.
double norm_of_sigmas(const Eigen::Matrix3d& covariance);

// Every number of it: what is not goes to nobody.
bool is_finite(const Solution& solution);

// 1 sigma of roll, pitch and yaw from the covariance of the attitude error seen in north, east,
// down (C_true = exp([error x]) C_nb); at most pi, also where the pitch makes them undefined.
Eigen::Vector3d sigma_of_euler(const Eigen::Matrix3d& attitude_covariance_n, double pitch,
                               double yaw);

}  // namespace leonav
