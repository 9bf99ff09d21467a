// This unit integrates satellite orbits in the Earth's gravity field with its first zonal
// harmonics.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

namespace leonav::sim {

inline constexpr double kGravityRadius = 6'378'136.3;  // m, of EGM2008's coefficients

// State in the inertial frame whose axes are those of ECEF at the start; m, m/s.
struct OrbitState {
  Eigen::Vector3d p_i, v_i;
};

// Returns the acceleration by the Earth's mass, J2, J3 and J4 (EGM2008), m/s^2. Vallado,
// Fundamentals of Astrodynamics, 4th ed., 8.6.1; here as the gradient of each zonal term in
// Cartesian form.
Eigen::Vector3d gravitation_i(const Eigen::Vector3d& p_i);

// Returns the states at t = 0, step, 2 step, ..., `count` of them from `first` on.
//
// `step_s` may be negative. The method is Runge-Kutta-Fehlberg of order 7 (8) at fixed steps of at
// most 30 s: below a millimetre in a day. `more` is any other acceleration at a position, t seconds
// after the first state.
using Perturbation = std::function<Eigen::Vector3d(const Eigen::Vector3d& p_i, double t)>;
std::vector<OrbitState> integrate_orbit(const OrbitState& first, double step_s, std::size_t count,
                                        const Perturbation& more = nullptr);

// Osculating Kepler elements; angles in rad. `node` is the right ascension in the inertial frame.
struct KeplerElements {
  double semi_major_axis_m, eccentricity, inclination, node, perigee, mean_anomaly;
};
OrbitState kepler_state(const KeplerElements& elements);

}  // namespace leonav::sim
