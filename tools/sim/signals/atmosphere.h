// Atmosphere gives the true tropospheric and ionospheric delays over the route.
#pragma once
#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/look_angles.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/signals/ionosphere.h"
#include "tools/sim/sky/clock_table.h"

namespace leonav::sim {

// Atmosphere draws its random walk when it is constructed.
class Atmosphere {
 public:
  explicit Atmosphere(const Scenario& scenario);

  // Returns the slant delay, m: a standard hydrostatic part and a random-walk wet part, both mapped
  // by Niell, and a horizontal gradient mapped by Chen and Herring (1997), J. Geophys. Res. 102,
  // 20489.
  double troposphere_m(double t, const Geodetic& antenna, const LookAngles& direction) const;
  double zenith_wet_m(double t, const Geodetic& antenna) const;

  const Ionosphere& ionosphere() const { return ionosphere_; }

 private:
  AtmosphereConfig config_;
  GpsTime start_;
  ClockTable wet_;  // a random walk; its "seconds" are metres
  Ionosphere ionosphere_;
};

}  // namespace leonav::sim
