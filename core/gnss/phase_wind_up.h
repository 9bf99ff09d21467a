// Phase wind-up: the carrier of a circularly polarized signal turns with the antennas.
#pragma once
#include <Eigen/Core>

namespace leonav {

// Wind-up in cycles, to be ADDED, times the wavelength, to the modelled carrier range. Wu et al.
// (1993), "Effects of antenna orientation on GPS carrier phase", Manuscripta Geodaetica 18, 91.
//   p_sat_e, p_a_e: satellite and antenna, ECEF, m.
//   C_es:           the satellite's axes (satellite_axes).
//   C_er:           the antenna's axes in ECEF, forward-right-down: C_en (its axes north, east,
//                   down) for one that stands, C_eb for one that is fixed to the vehicle.
//   previous:       the last value of this arc (0 at its start, whose whole cycles the ambiguity
//                   takes up). The result is the one within half a cycle of it: turns are counted
//                   as long as they are less than half a cycle per call. A LEO pass over an antenna
//                   at rest turns by 1e-4 cycles a second, a vehicle by its yaw rate.
// A satellite at the antenna's place, or not finite input, returns `previous`.
double phase_wind_up_cycles(const Eigen::Vector3d& p_sat_e, const Eigen::Matrix3d& C_es,
                            const Eigen::Vector3d& p_a_e, const Eigen::Matrix3d& C_er,
                            double previous);

}  // namespace leonav
