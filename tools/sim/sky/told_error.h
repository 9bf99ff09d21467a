// The error of what the receiver is told of one satellite.
#pragma once
#include <string>

#include "core/gnss/satellite.h"
#include "tools/sim/scenario/constellation_config.h"
#include "tools/sim/sky/orbit_integrator.h"

namespace leonav::sim {

// Orbit errors, and the varying part of the clock's, turn over with the revolution: a sine and a
// cosine of it. With ToldErrors::update_s all are drawn anew so often and step.
class ToldError {
 public:
  // `what` names the stream of random numbers.
  ToldError(const ToldErrors& sigma, SatelliteId satellite, double period_s, std::uint64_t seed,
            std::string what);

  Eigen::Vector3d orbit_m(double t) const;  // along, cross, radial
  double clock_m(double t) const;

 private:
  std::uint64_t stream_of(double t) const;

  ToldErrors sigma_;
  SatelliteId satellite_;
  double rate_;
  std::uint64_t seed_;
  std::string what_;
};

// Seconds of one revolution.
double period_s(const OrbitState& state);
// From along, cross, radial to the inertial axes of `state`.
Eigen::Vector3d in_inertial(const OrbitState& state, const Eigen::Vector3d& along_cross_radial);

}  // namespace leonav::sim
