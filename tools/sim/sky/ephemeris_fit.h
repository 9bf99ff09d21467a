// This unit fits broadcast elements to an orbit, as a control segment would compute them.
#pragma once
#include <span>

#include "core/gnss/orbits/ephemeris.h"
#include "tools/sim/sky/orbit_integrator.h"

namespace leonav::sim {

// One sample of the orbit.
struct OrbitSample {
  GpsTime time;
  Eigen::Vector3d p_e;  // m
};

// Result of a fit.
struct EphemerisFit {
  Ephemeris elements;                 // orbit elements only; clock, health and the rest as given
  double rms_m = 0.0, worst_m = 0.0;  // 3D, over the samples
};

// Fits the fifteen elements of IS-GPS-200 table 20-III, and of a LEO satellite the two rates, to
// `samples` (two dozen or more, around given.toe).
//
// The method is Gauss-Newton with Levenberg-Marquardt damping. Satellite, message and toe of
// `given` must be set. `at_toe` is the state at toe, in the inertial axes that coincide with ECEF
// then, from which the iteration starts. Eccentricity and perigee enter as e cos(omega), e
// sin(omega), so that circular orbits are no special case. Weak priors of the true size of the
// harmonics separate what short arcs cannot.
EphemerisFit fit_ephemeris(const Ephemeris& given, const OrbitState& at_toe,
                           std::span<const OrbitSample> samples);

}  // namespace leonav::sim
