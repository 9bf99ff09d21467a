#include "tools/sim/signals/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "core/gnss/troposphere.h"
#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {
namespace {

constexpr double kShellHeight = 450e3;  // m
constexpr double kMeanRadius = 6371e3;

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
      origin_(scenario.route.origin),
      wet_(wet_walk(scenario)) {}

double Atmosphere::zenith_wet_m(double t, const Geodetic& antenna) const {
  return saastamoinen_zenith_delays(antenna).wet_m + wet_.at(t).offset_s;
}

double Atmosphere::troposphere_m(double t, const Geodetic& antenna, double elevation) const {
  const TroposphereMapping mapping = niell_mapping(antenna, elevation, start_.plus_seconds(t));
  return saastamoinen_zenith_delays(antenna).hydrostatic_m * mapping.hydrostatic +
         zenith_wet_m(t, antenna) * mapping.wet;
}

double Atmosphere::tecu(const Geodetic& antenna, const LookAngles& direction) const {
  const double ratio = kMeanRadius / (kMeanRadius + kShellHeight);
  const double zenith = std::asin(ratio * std::cos(direction.elevation));
  const double angle = 0.5 * 3.141592653589793 - direction.elevation - zenith;  // at the centre
  // Where the ray pierces the shell, from the origin, km to the north.
  const double north_km =
      1e-3 * kMeanRadius *
      (angle * std::cos(direction.azimuth) + antenna.latitude - origin_.latitude);
  const double vertical =
      config_.tecu * std::max(0.1, 1.0 - config_.tec_gradient_per_km * 0.1 * north_km);
  return vertical / std::cos(zenith);
}

double delay_per_tecu_m(double frequency_hz) { return 40.308e16 / (frequency_hz * frequency_hz); }

}  // namespace leonav::sim
