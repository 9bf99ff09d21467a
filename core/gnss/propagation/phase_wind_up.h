// This unit models phase wind-up: the carrier of a circularly polarized signal turns with the
// antennas.
#pragma once
#include <Eigen/Core>

namespace leonav {

// Returns the wind-up in cycles, to be ADDED, times the wavelength, to the modelled carrier range.
// Source: Wu et al. (1993), "Effects of antenna orientation on GPS carrier phase", Manuscripta
// Geodaetica 18, 91.
//   p_sat_e, p_a_e: satellite and antenna, ECEF, m.
//   C_es:           the satellite's axes (satellite_axes).
//   C_er:           the antenna's axes in ECEF, forward-right-down: C_en (axes north, east, down)
//   for
//                   a stationary antenna, C_eb for one fixed to the vehicle.
//   previous:       the last value of this arc; 0 at its start, whose whole cycles become part of
//   the
//                   ambiguity.
// The result is the value within half a cycle of `previous`: turns are counted as long as they are
// less than half a cycle per call. A LEO pass over an antenna at rest turns by 1e-4 cycles a
// second, a vehicle by its yaw rate. A satellite at the antenna's position, or input that is not
// finite, returns `previous`.
double phase_wind_up_cycles(const Eigen::Vector3d& p_sat_e, const Eigen::Matrix3d& C_es,
                            const Eigen::Vector3d& p_a_e, const Eigen::Matrix3d& C_er,
                            double previous);

}  // namespace leonav
