// These functions derive from the filter what stages and monitors need: sigmas and a solution.
#pragma once
#include <Eigen/Core>

#include "core/filter/ekf.h"
#include "core/integrity/protection_levels.h"
#include "core/navigator/interface/solution.h"

namespace leonav {

// Returns the 3D sigma of the position, m: the root of the sum of its three variances.
double position_sigma(const Ekf& filter);
// Returns the velocity's sigma per component, m/s: the root of the mean of its three variances.
double velocity_sigma(const Ekf& filter);
// Returns the largest sigma of the gyro bias among the three axes, rad/s.
double gyro_bias_sigma(const Ekf& filter);

// Fills `solution` with the filter's estimate at the stamp of its epoch, but for sequence, source,
// anchor, jump and protection levels. Precondition: the filter is initialized.
void fill_solution(const Ekf& filter, Solution* solution);
// Returns the error of the filter's solution, as the protection levels need it. Precondition:
// `solution` is from fill_solution().
NominalError nominal_error(const Ekf& filter, const Solution& solution);
// Returns 1 sigma of roll, pitch and yaw as published, rad; zero without attitude.
Eigen::Vector3d sigma_of_euler(const Ekf& filter);

}  // namespace leonav
