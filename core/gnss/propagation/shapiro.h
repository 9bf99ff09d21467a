// This unit models the gravitational delay of the signal in the Earth's field.
#pragma once
#include <Eigen/Core>

namespace leonav {

// Returns the metres to ADD to the geometric range:
//   2 GM/c^2 ln((r1 + r2 + rho) / (r1 + r2 - rho)),
// IERS Conventions (2010), eq. 11.17; 6 mm (LEO) to 20 mm. Both positions are of the same instant
// in one frame, in m. The delay is zero where they coincide or lie on opposite sides of the Earth's
// centre, in line with it.
double shapiro_delay_m(const Eigen::Vector3d& p_sat_e, const Eigen::Vector3d& p_a_e);

}  // namespace leonav
