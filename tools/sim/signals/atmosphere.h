// The true troposphere and ionosphere over the route.
#pragma once
#include "core/earth/ellipsoid.h"
#include "core/gnss/look_angles.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/sky/clock_table.h"

namespace leonav::sim {

class Atmosphere {
 public:
  explicit Atmosphere(const Scenario& scenario);

  // Slant delay, m: standard hydrostatic part, wet part that walks, both mapped by Niell.
  double troposphere_m(double t, const Geodetic& antenna, double elevation) const;
  double zenith_wet_m(double t, const Geodetic& antenna) const;
  // Slant electron content in 1e16 / m^2: thin shell at 450 km, linear horizontal gradient.
  double tecu(const Geodetic& antenna, const LookAngles& direction) const;

 private:
  AtmosphereConfig config_;
  GpsTime start_;
  Geodetic origin_;
  ClockTable wet_;  // a random walk like any other; its "seconds" are metres
};

// Group delay in m of one unit on `frequency_hz`; the carrier is advanced by as much.
double delay_per_tecu_m(double frequency_hz);

}  // namespace leonav::sim
