// An inertial state and its covariance in ECEF are converted to a Solution here: geodetic, NED.
#pragma once
#include <Eigen/Core>

#include "core/inertial/strapdown/nav_state.h"
#include "core/navigator/interface/solution.h"

namespace leonav {

// Covariance of position, velocity and attitude errors in ECEF, in the order of ekf_index.
using PvaCovariance = Eigen::Matrix<double, 9, 9>;

// Moves the position of a state that is `time_offset_s` later than its stamp back to the stamp:
// p_e - time_offset_s v_e. Velocity and attitude stay, for the offset is some milliseconds.
NavState at_stamp(const NavState& state, double time_offset_s);

// Fills time, position, velocity, attitude, their sigmas and the IMU errors; leaves the rest of
// `solution` (sequence, source, anchor, jump) to the caller. Without attitude the angles and their
// sigmas are zero.
void fill_solution(const NavState& state, const PvaCovariance& covariance, bool has_attitude,
                   Solution* solution);

// Root of the sum of the variances; 0 where the sum is negative, NaN where it is NaN.
double norm_of_sigmas(const Eigen::Matrix3d& covariance);

// All numbers of the solution are finite. One that is not is never published.
bool is_finite(const Solution& solution);

// 1 sigma of roll, pitch and yaw from the covariance of the attitude error seen in north, east,
// down (C_true = exp([error x]) C_nb); at most pi, also where the pitch makes them undefined.
Eigen::Vector3d sigma_of_euler(const Eigen::Matrix3d& attitude_covariance_n, double pitch,
                               double yaw);

}  // namespace leonav
