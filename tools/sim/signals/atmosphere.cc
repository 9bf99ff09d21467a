#include "tools/sim/signals/atmosphere.h"

#include <cmath>

#include "core/gnss/propagation/troposphere.h"
#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {
namespace {

ClockTable wet_walk(const Scenario& scenario) {
  ClockErrors walk;
  walk.offset_s = scenario.atmosphere.wet_offset_m;
  walk.phase_walk_s = scenario.atmosphere.wet_walk_m_per_sqrt_s;
  return ClockTable(-60.0, scenario.duration_s + 60.0, 60.0, walk,
                    random_stream(scenario.seed, "wet delay"));
}

}  // namespace

Atmosphere::Atmosphere(const Scenario& scenario)
    : config_(scenario.atmosphere),
      start_(scenario.start),
      wet_(wet_walk(scenario)),
      ionosphere_(scenario) {}

double Atmosphere::zenith_wet_m(double t, const Geodetic& antenna) const {
  return saastamoinen_zenith_delays(antenna).wet_m + wet_.at(t).offset_s;
}

double Atmosphere::troposphere_m(double t, const Geodetic& antenna,
                                 const LookAngles& direction) const {
  const double e = direction.elevation;
  const TroposphereMapping mapping = niell_mapping(antenna, e, start_.plus_seconds(t));
  const double gradient = config_.wet_gradient_north_m * std::cos(direction.azimuth) +
                          config_.wet_gradient_east_m * std::sin(direction.azimuth);
  constexpr double kChenHerring = 0.0032;
  return saastamoinen_zenith_delays(antenna).hydrostatic_m * mapping.hydrostatic +
         zenith_wet_m(t, antenna) * mapping.wet +
         gradient / (std::sin(e) * std::tan(e) + kChenHerring);
}

}  // namespace leonav::sim
