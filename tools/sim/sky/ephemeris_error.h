// EphemerisError gives the error of one satellite's orbit and clock product.
#pragma once
#include <string>

#include "core/gnss/signals/satellite.h"
#include "tools/sim/scenario/constellation_config.h"
#include "tools/sim/sky/orbit_integrator.h"

namespace leonav::sim {

// Orbit errors, and the varying part of the clock's, vary with the revolution, as a sine and a
// cosine. With EphemerisErrors::update_s all are drawn anew at that interval, in steps.
class EphemerisError {
 public:
  // `what` names the stream of random numbers.
  EphemerisError(const EphemerisErrors& sigma, SatelliteId satellite, double period_s,
                 std::uint64_t seed, std::string what);

  Eigen::Vector3d orbit_m(double t) const;  // along, cross, radial
  double clock_m(double t) const;

 private:
  std::uint64_t stream_of(double t) const;

  EphemerisErrors sigma_;
  SatelliteId satellite_;
  double rate_;
  std::uint64_t seed_;
  std::string what_;
};

// Returns the seconds of one revolution.
double period_s(const OrbitState& state);
// Rotates from along, cross, radial to the inertial axes of `state`.
Eigen::Vector3d in_inertial(const OrbitState& state, const Eigen::Vector3d& along_cross_radial);

}  // namespace leonav::sim
