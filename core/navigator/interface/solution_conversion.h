// These functions convert an inertial state and its covariance in ECEF to a Solution.
#pragma once
#include <Eigen/Core>

#include "core/inertial/strapdown/nav_state.h"
#include "core/integrity/protection_levels.h"
#include "core/navigator/interface/solution.h"

namespace leonav {

// Covariance of position, velocity and attitude errors in ECEF, in the order of ekf_index.
using PvaCovariance = Eigen::Matrix<double, 9, 9>;

// Returns a state that is `time_offset_s` later than its stamp with its position moved back to the
// stamp: p_e - time_offset_s v_e. Velocity and attitude stay, because the offset is some
// milliseconds.
NavState at_stamp(const NavState& state, double time_offset_s);

// Fills time, position, velocity, attitude, their sigmas and the IMU errors of `solution`. The
// caller fills the rest: sequence, source, anchor, jump, protection levels. Without attitude the
// angles and their sigmas are zero.
void fill_solution(const NavState& state, const PvaCovariance& covariance, bool has_attitude,
                   Solution* solution);

// Returns the error of a solution that fill_solution() has made of `covariance`, as the protection
// levels need it.
NominalError nominal_error(const PvaCovariance& covariance, const Solution& solution);
void set_levels(const ProtectionLevels& levels, Solution* solution);

// Returns the root of the sum of the three variances; 0 if the sum is negative, NaN if it is NaN.
double norm_of_sigmas(const Eigen::Matrix3d& covariance);

// Returns whether all numbers of the solution are finite. Otherwise it must not be published.
bool is_finite(const Solution& solution);

// Returns 1 sigma of roll, pitch and yaw, rad, from the covariance of the attitude error in north,
// east, down: C_nb_true = exp([error x]) C_nb. Each is at most pi, and all are pi at
// a pitch of 90 degrees, where the angles are undefined.
Eigen::Vector3d sigma_of_euler(const Eigen::Matrix3d& attitude_covariance_n, double pitch,
                               double yaw);

}  // namespace leonav
