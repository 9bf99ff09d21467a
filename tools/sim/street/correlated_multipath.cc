#include "tools/sim/street/correlated_multipath.h"

#include <algorithm>
#include <cmath>

#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {
namespace {

constexpr double kMediumOrbit = 1.2e-4;  // rad/s over the sky
constexpr double kBlend_s = 1.0;         // from the sigmas of one episode to those of the next

double drawn(const Range& range, double uniform) {
  return range.least + (range.most - range.least) * uniform;
}

}  // namespace

CorrelatedMultipath::CorrelatedMultipath(const StreetErrorsConfig& config, std::uint64_t seed,
                                         std::size_t satellite)
    : config_(config),
      seed_(seed),
      satellite_(satellite),
      code_{GaussMarkov(stream_key(seed, "street multipath of code", satellite)),
            {GaussMarkov(stream_key(seed, "street code of signal", signal_number(satellite, 0))),
             GaussMarkov(stream_key(seed, "street code of signal", signal_number(satellite, 1)))}},
      carrier_{
          GaussMarkov(stream_key(seed, "street multipath of carrier", satellite)),
          {GaussMarkov(stream_key(seed, "street carrier of signal", signal_number(satellite, 0))),
           GaussMarkov(
               stream_key(seed, "street carrier of signal", signal_number(satellite, 1)))}} {}

void CorrelatedMultipath::begin_episode(double t, bool is_low) {
  const StreetMultipathConfig& multipath = config_.multipath;
  GaussianGenerator random = random_stream(
      seed_, "street episode", (static_cast<std::uint64_t>(episode_) << 16) | satellite_);
  before_ = sigmas(t);
  now_.code_m = drawn(is_low ? multipath.code_low_m : multipath.code_high_m, random.uniform());
  now_.carrier_m =
      drawn(is_low ? multipath.carrier_low_m : multipath.carrier_high_m, random.uniform());
  time_s_ = drawn(multipath.time_s, random.uniform());
  if (episode_ == 0) before_ = now_;
  began_s_ = t;
  until_s_ = t - multipath.episode_s * std::log(random.uniform());
  is_low_ = is_low;
  ++episode_;
}

// Returns the sigmas on the way from those of the episode before to those of this one.
CorrelatedMultipath::Sigmas CorrelatedMultipath::sigmas(double t) const {
  const double x = std::clamp((t - began_s_) / kBlend_s, 0.0, 1.0);
  const double share = x * x * (3.0 - 2.0 * x), share_rate = 6.0 * x * (1.0 - x) / kBlend_s;
  const double carrier_change_m = now_.carrier_m - before_.carrier_m;
  return {before_.code_m + share * (now_.code_m - before_.code_m),
          before_.carrier_m + share * carrier_change_m, share_rate * carrier_change_m};
}

GaussMarkov::Value CorrelatedMultipath::mixed(Processes* processes, std::size_t signal) const {
  const double r = config_.multipath.correlation;
  const double common = std::sqrt(r), own = std::sqrt(1.0 - r);
  const GaussMarkov::Value both = processes->common.at(argument_);
  const GaussMarkov::Value one = processes->own[signal].at(argument_);
  return {common * both.value + own * one.value, common * both.slope + own * one.slope};
}

std::array<StreetSignalError, kTrackedSignals> CorrelatedMultipath::at(
    const SatelliteSight& sight) {
  const bool is_low = sight.elevation < config_.limit_elevation;
  const double quickness = std::max(1.0, sight.turn / kMediumOrbit);
  if (episode_ > 0) argument_ += quickness / time_s_ * (sight.t - t_);
  t_ = sight.t;
  if (episode_ == 0 || sight.t >= until_s_ || is_low != is_low_) begin_episode(sight.t, is_low);
  const double rate = quickness / time_s_;
  const Sigmas sigma = sigmas(sight.t);
  std::array<StreetSignalError, kTrackedSignals> errors;
  for (std::size_t s = 0; s < kTrackedSignals; ++s) {
    const GaussMarkov::Value code = mixed(&code_, s), carrier = mixed(&carrier_, s);
    errors[s].code_m = sigma.code_m * code.value;
    errors[s].carrier_m = sigma.carrier_m * carrier.value;
    errors[s].doppler_m_s =
        sigma.carrier_m * carrier.slope * rate + sigma.carrier_m_s * carrier.value;
  }
  return errors;
}

}  // namespace leonav::sim
