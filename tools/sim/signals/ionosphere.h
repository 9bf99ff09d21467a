// The true ionosphere: electrons on a thin shell over the route.
#pragma once
#include <array>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "core/gnss/look_angles.h"
#include "core/gnss/satellite.h"
#include "tools/sim/scenario/lattice_noise.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Vertical content with a daily curve (full at 14 h local solar time, least at 2 h), linear
// gradients, a travelling wave; mapped to the slant by the angle at a shell at 450 km. A satellite
// in a low orbit (970 km) has, as a simplification, the content of a whole path to space: what lies
// above it is a tenth or less, and a navigator with two frequencies does not feel it.
class Ionosphere {
 public:
  explicit Ionosphere(const Scenario& scenario);

  // Slant electron content in 1e16 / m^2.
  double tecu(double t, SatelliteId satellite, const Geodetic& antenna,
              const LookAngles& direction) const;
  // What scintillation takes from the C/N0, dB; may be negative.
  double fading_db(double t, SatelliteId satellite) const;

 private:
  double vertical_tecu(double t, double north_km, double east_km, double longitude) const;

  AtmosphereConfig config_;
  Geodetic origin_;
  double start_of_day_s_;                     // GPS time of day at t = 0
  std::vector<LatticeNoise> flicker_, fade_;  // by place_of(satellite)
};

// Group delay in m of one unit on `frequency_hz`; the carrier is advanced by as much.
double delay_per_tecu_m(double frequency_hz);

}  // namespace leonav::sim
