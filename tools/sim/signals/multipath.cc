#include "tools/sim/signals/multipath.h"

#include <algorithm>
#include <cmath>

#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {

void MultipathAge::advance(double t, double elevation, const LookAngles& rates) {
  constexpr double kMediumOrbit = 1.2e-4;  // rad/s: GPS, Galileo and most of BeiDou, over the sky
  constexpr double kSlowest = 0.1;         // geostationary satellites: the surroundings change
  const double turn = std::hypot(rates.elevation, rates.azimuth * std::cos(elevation));
  const double rate = std::max(kSlowest, turn / kMediumOrbit);
  if (started_) seconds_ += 0.5 * (rate_ + rate) * (t - t_);
  started_ = true;
  t_ = t;
  rate_ = rate;
}

MultipathError Multipath::error(SatelliteId satellite, std::size_t signal, double elevation,
                                const MultipathAge& age, double travelled_m, double speed_m_s,
                                double strength) const {
  const double height = strength * std::exp(-std::max(0.0, elevation) / config_.elevation);
  // Code and carrier share one argument, because the reflectors' geometry changes with the
  // satellite or the vehicle.
  const double argument = age.seconds() / config_.time_s + travelled_m / config_.length_m;
  const double argument_rate = age.rate() / config_.time_s + speed_m_s / config_.length_m;
  const std::uint64_t number = signal_number(table_index_of(satellite), signal);
  MultipathError error;
  if (config_.code_m > 0.0) {
    const LatticeNoise code(stream_key(seed_, "multipath of code", number));
    error.code_m = height * config_.code_m * code.at(argument).value;
  }
  if (config_.carrier_m > 0.0) {
    const LatticeNoise carrier(stream_key(seed_, "multipath of carrier", number));
    const LatticeNoise::Value now = carrier.at(argument);
    // The largest carrier error of reflections weaker than the signal is a quarter of the shortest
    // wavelength. The strength of a place refers to codes; for carriers its root counts.
    const double sigma = config_.carrier_m * height / std::sqrt(std::max(strength, 1.0));
    error.carrier_m = sigma * now.value;
    error.doppler_m_s = sigma * now.slope * argument_rate;
  }
  return error;
}

}  // namespace leonav::sim
