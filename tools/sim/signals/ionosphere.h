// Ionosphere gives the true electron content on a thin shell over the route.
#pragma once
#include <array>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/look_angles.h"
#include "core/gnss/signals/satellite.h"
#include "tools/sim/scenario/lattice_noise.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// The vertical content has a daily curve (maximum at 14 h local solar time, minimum at 2 h), linear
// gradients and a travelling wave.
//
// It is mapped to the slant by the angle at a shell at 450 km. As a simplification, a satellite in
// a low orbit (970 km) has the content of the whole path to space: the part above it is a tenth or
// less, and a navigator with two frequencies is not affected.
class Ionosphere {
 public:
  explicit Ionosphere(const Scenario& scenario);

  // Returns the slant electron content in 1e16 / m^2.
  double tecu(double t, SatelliteId satellite, const Geodetic& antenna,
              const LookAngles& direction) const;
  // Returns the loss of C/N0 by scintillation, dB; it may be negative.
  double fading_db(double t, SatelliteId satellite) const;

 private:
  double vertical_tecu(double t, double north_km, double east_km, double longitude) const;

  AtmosphereConfig config_;
  Geodetic origin_;
  double start_of_day_s_;                     // GPS time of day at t = 0
  std::vector<LatticeNoise> flicker_, fade_;  // by table_index_of(satellite)
};

// Returns the group delay, m, of one unit on `frequency_hz`; the carrier is advanced by as much.
double delay_per_tecu_m(double frequency_hz);

}  // namespace leonav::sim
