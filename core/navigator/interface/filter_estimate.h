// These are the scalars that stages and monitors derive from the filter: sigmas, and its solution.
#pragma once
#include <Eigen/Core>

#include "core/filter/ekf.h"
#include "core/navigator/interface/solution.h"

namespace leonav {

// Root of the sum of the position's variances over three axes, m.
double position_sigma(const Ekf& filter);
// Root of the mean of the velocity's variances over three axes, m/s.
double velocity_sigma(const Ekf& filter);
// The largest of the three axes, rad/s.
double gyro_bias_sigma(const Ekf& filter);

// The filter's estimate at the stamp of its epoch; leaves sequence, source, anchor and jump of
// `solution` to the caller. The filter must be initialized.
void fill_solution(const Ekf& filter, Solution* solution);
// 1 sigma of roll, pitch and yaw as published, rad; zero without attitude.
Eigen::Vector3d sigma_of_euler(const Ekf& filter);

}  // namespace leonav
