// Broadcast elements that follow an orbit, as a control segment would compute them.
#pragma once
#include <span>

#include "core/gnss/ephemeris.h"
#include "tools/sim/sky/orbit_integrator.h"

namespace leonav::sim {

struct OrbitSample {
  GpsTime time;
  Eigen::Vector3d p_e;  // m
};

struct EphemerisFit {
  Ephemeris elements;  // only the orbit's; clock, health and the like as they were given
  double rms_m = 0.0, worst_m = 0.0;  // 3D, over the samples
};

// Least squares over `samples` (two dozen or more, around given.toe), the fifteen elements of
// IS-GPS-200 table 20-III, by Gauss and Newton with Levenberg's and Marquardt's damping. Of `given`
// satellite, message and toe must be set. `at_toe`: the state at toe in the inertial axes that
// coincide with ECEF then, from which the iteration starts. Eccentricity and perigee enter as
// e cos(omega), e sin(omega), so that circular orbits are no special case; weak priors of the size
// that the harmonics have in truth keep apart what short arcs cannot.
EphemerisFit fit_ephemeris(const Ephemeris& given, const OrbitState& at_toe,
                           std::span<const OrbitSample> samples);

}  // namespace leonav::sim
