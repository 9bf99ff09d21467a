// The true troposphere and ionosphere over the route.
#pragma once
#include "core/earth/ellipsoid.h"
#include "core/gnss/look_angles.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/signals/ionosphere.h"
#include "tools/sim/sky/clock_table.h"

namespace leonav::sim {

class Atmosphere {
 public:
  explicit Atmosphere(const Scenario& scenario);

  // Slant delay, m: standard hydrostatic part, wet part that walks, both mapped by Niell; a
  // horizontal gradient mapped as Chen and Herring (1997), J. Geophys. Res. 102, 20489.
  double troposphere_m(double t, const Geodetic& antenna, const LookAngles& direction) const;
  double zenith_wet_m(double t, const Geodetic& antenna) const;

  const Ionosphere& ionosphere() const { return ionosphere_; }

 private:
  AtmosphereConfig config_;
  GpsTime start_;
  ClockTable wet_;  // a random walk like any other; its "seconds" are metres
  Ionosphere ionosphere_;
};

}  // namespace leonav::sim
