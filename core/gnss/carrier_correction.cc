#include "core/gnss/carrier_correction.h"

#include <cmath>

#include "core/gnss/ionosphere.h"
#include "core/gnss/path_correction.h"
#include "core/gnss/weighting.h"

namespace leonav {
namespace {

// Broadcast orbits and clocks err by a metre that turns over in hours, precise ones by two or three
// centimetres that turn over in a quarter of a revolution: hours again, or minutes for LEO.
constexpr double kBroadcastWander = 0.002;    // m/sqrt(s)
constexpr double kPreciseWander = 0.0001;     // m/sqrt(s)
constexpr double kPreciseWanderLeo = 0.0005;  // m/sqrt(s)
// What the ionosphere model leaves of a GNSS satellite's slant delay moves by a millimetre per
// second, up or down for minutes; past a LEO satellite the whole delay changes within minutes.
constexpr double kIonosphereWander = 0.01;     // m/sqrt(s)
constexpr double kIonosphereWanderLeo = 0.05;  // m/sqrt(s)

double square(double x) { return x * x; }

double orbit_wander(const SatelliteInView& satellite) {
  if (satellite.source == OrbitSource::kBroadcast) return kBroadcastWander;
  return satellite.satellite.system == System::kLeo ? kPreciseWanderLeo : kPreciseWander;
}

}  // namespace

Measurement carrier_measurement(const DelayContext& context, const SignalObservation& first,
                                const SignalObservation* second, const CarrierStatus& status,
                                const SatelliteInView& satellite) {
  const System system = satellite.satellite.system;
  const double sigma0 = context.config->systems[index_of(system)].sigma.carrier_m;
  const double f1 = frequency_hz(system, first.code.band);
  const double noise1 = sigma0 * noise_factor(*context.config, satellite.elevation, first.cn0_dbhz);

  Measurement carrier;
  carrier.observable = Observable::kCarrier;
  carrier.code = first.code;
  carrier.arc = status.arc;
  double range = status.first_m - satellite.wind_up_cycles * kSpeedOfLight / f1;
  double noise = noise1;
  double wander = square(orbit_wander(satellite));
  if (second != nullptr) {
    const double f2 = frequency_hz(system, second->code.band);
    const IonosphereFree pair = ionosphere_free(f1, f2);
    carrier.second_code = second->code;
    range = pair.gamma1 * range +
            pair.gamma2 * (status.second_m - satellite.wind_up_cycles * kSpeedOfLight / f2);
    noise = combined_sigma(
        pair, noise1,
        sigma0 * noise_factor(*context.config, satellite.elevation, second->cn0_dbhz));
  } else {
    const LookAngles direction{satellite.elevation, satellite.azimuth};
    // The ionosphere delays the code and advances the carrier by the same.
    range += klobuchar_delay_m(*context.klobuchar, context.antenna, direction, context.time, f1);
    wander += square(system == System::kLeo ? kIonosphereWanderLeo : kIonosphereWander);
  }
  carrier.value = range + satellite.clock_m - satellite.troposphere_m - satellite.path_m -
                  antenna_range(context, satellite, carrier.code, carrier.second_code).range_m;
  // Half a cycle may yet come or go: a quarter either way.
  const double half_cycle =
      status.half_cycle_unresolved ? 0.25 * kSpeedOfLight / f1 * noise / noise1 : 0.0;
  carrier.sigma = std::hypot(noise, satellite.orbit_sigma_change_m, half_cycle);
  carrier.wander = std::sqrt(wander);
  return carrier;
}

}  // namespace leonav
