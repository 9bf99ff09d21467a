#include "tools/sim/signals/ionosphere.h"

#include <algorithm>
#include <cmath>

#include "core/base/angle.h"
#include "core/base/capacity.h"
#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {
namespace {

constexpr double kShellHeight = 450e3;  // m
constexpr double kMeanRadius = 6371e3;
constexpr double kDay_s = 86'400.0;
constexpr double kGradientReach_km = 500.0;

}  // namespace

Ionosphere::Ionosphere(const Scenario& scenario)
    : config_(scenario.atmosphere), origin_(scenario.route.origin) {
  const double since_epoch_s =
      static_cast<double>(scenario.start.nanoseconds() / kNanosecondsPerSecond);
  start_of_day_s_ = std::fmod(since_epoch_s, kDay_s);
  for (std::size_t i = 0; i < kMaxEphemerisSatellites; ++i) {
    flicker_.emplace_back(stream_key(scenario.seed, "scintillation of phase", i));
    fade_.emplace_back(stream_key(scenario.seed, "scintillation of amplitude", i));
  }
}

double Ionosphere::vertical_tecu(double t, double north_km, double east_km,
                                 double longitude) const {
  const double day = (start_of_day_s_ + t) / kDay_s + 0.5 * longitude / kPi;  // in local solar time
  const double sun = 0.5 * (1.0 + std::cos(2.0 * kPi * (day - 14.0 / 24.0)));
  const double curve = config_.night_share + (1.0 - config_.night_share) * sun * sun;
  const double along_m =
      1e3 * (north_km * std::cos(config_.wave_azimuth) + east_km * std::sin(config_.wave_azimuth));
  const double wave =
      std::sin(2.0 * kPi * (along_m / config_.wave_length_m - t / config_.wave_period_s));
  // Gradients are limited to the region, and the content is never negative. Both limits are smooth,
  // because a Doppler would show a kink.
  const auto near = [](double km) { return kGradientReach_km * std::tanh(km / kGradientReach_km); };
  const double sum = config_.tecu * curve + config_.gradient_north_tecu_per_km * near(north_km) +
                     config_.gradient_east_tecu_per_km * near(east_km) + config_.wave_tecu * wave;
  const double least = 0.1 * config_.tecu;
  return 0.5 * (sum + std::hypot(sum, least));
}

double Ionosphere::tecu(double t, SatelliteId satellite, const Geodetic& antenna,
                        const LookAngles& direction) const {
  const double ratio = kMeanRadius / (kMeanRadius + kShellHeight);
  const double zenith = std::asin(ratio * std::cos(direction.elevation));
  const double angle = 0.5 * kPi - direction.elevation - zenith;  // at the Earth's centre
  // The point where the ray pierces the shell, relative to the origin.
  const double north = angle * std::cos(direction.azimuth) + antenna.latitude - origin_.latitude;
  const double cosine = std::max(0.05, std::cos(antenna.latitude));
  const double east =
      angle * std::sin(direction.azimuth) + (antenna.longitude - origin_.longitude) * cosine;
  double vertical = vertical_tecu(t, 1e-3 * kMeanRadius * north, 1e-3 * kMeanRadius * east,
                                  antenna.longitude + angle * std::sin(direction.azimuth) / cosine);
  if (config_.scintillation_tecu > 0.0) {
    const double argument = t / config_.scintillation_time_s;
    vertical += config_.scintillation_tecu * flicker_[table_index_of(satellite)].at(argument).value;
  }
  return vertical / std::cos(zenith);
}

double Ionosphere::fading_db(double t, SatelliteId satellite) const {
  if (config_.scintillation_db == 0.0) return 0.0;
  const double argument = t / config_.scintillation_time_s;
  return config_.scintillation_db * fade_[table_index_of(satellite)].at(argument).value;
}

double delay_per_tecu_m(double frequency_hz) { return 40.308e16 / (frequency_hz * frequency_hz); }

}  // namespace leonav::sim
