#include "tools/sim/street/correlated_street.h"

#include <cmath>

#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {

CorrelatedStreet::CorrelatedStreet(const StreetErrorsConfig& config, std::uint64_t seed,
                                   std::size_t satellite)
    : config_(config),
      seed_(seed),
      satellite_(satellite),
      multipath_(config, seed, satellite),
      reflected_(stream_key(seed, "street reflected", satellite), config.reflected.share,
                 config.reflected.duration_s),
      blocked_(stream_key(seed, "street blocked", satellite), config.blocked.share,
               config.blocked.duration_s),
      slips_(config.slips, stream_key(seed, "street slips", satellite)) {}

void CorrelatedStreet::reflect(double t, StreetEffect* effect) const {
  const StreetReflectedConfig& reflected = config_.reflected;
  GaussianGenerator random =
      random_stream(seed_, "street reflection",
                    (static_cast<std::uint64_t>(reflected_.episode()) << 16) | satellite_);
  const double longer = reflected.path_m.most / reflected.path_m.least;
  const double path_m = reflected.path_m.least * std::pow(longer, random.uniform());
  const double rate_m_s = reflected.drift_m_s * (2.0 * random.uniform() - 1.0);
  effect->loss_db = reflected.loss_db.least +
                    (reflected.loss_db.most - reflected.loss_db.least) * random.uniform();
  effect->route = reflected_.episode();
  effect->extra_m = path_m + rate_m_s * (t - reflected_.since_s());
  effect->extra_m_s = rate_m_s;
  // A reflection is never earlier than the signal itself: its path stops to shrink at a half.
  if (effect->extra_m >= 0.5 * path_m) return;
  effect->extra_m = 0.5 * path_m;
  effect->extra_m_s = 0.0;
}

StreetEffect CorrelatedStreet::at(const SatelliteSight& sight) {
  StreetEffect effect;
  effect.signals = multipath_.at(sight);
  effect.slips = slips_.until(sight.t);
  reflected_.advance(sight.t);
  blocked_.advance(sight.t);
  if (sight.elevation >= config_.limit_elevation) return effect;
  effect.possible = !blocked_.is_on();
  if (reflected_.is_on()) reflect(sight.t, &effect);
  return effect;
}

}  // namespace leonav::sim
