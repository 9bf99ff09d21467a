#include "core/gnss/preprocessing/internal/code_correction.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/earth/tides.h"
#include "core/gnss/measurement/weighting.h"
#include "core/gnss/preprocessing/internal/path_correction.h"
#include "core/gnss/propagation/group_delay.h"
#include "core/gnss/propagation/ionosphere.h"
#include "core/gnss/propagation/troposphere.h"

namespace leonav {
namespace {

constexpr double kHalfPi = 1.5707963267948966;
constexpr double kL1Frequency = 1575.42e6;  // Hz

// Klobuchar's model leaves about half of the delay, and never less than this at zenith on L1
// (night, quiet sun: the constant 1.5 m of the model is itself uncertain by that order).
constexpr double kIonosphereFloor = 0.5;  // m
// Without broadcast coefficients the error may reach the delay itself, and is never less than this:
// the electron content of the day is not known.
constexpr double kUnknownModelShare = 1.0;
constexpr double kUnknownFloor = 2.0;  // m

// Share of this error's variance that satellites do not have in common: gradients and waves of the
// electron content.
constexpr double kIndividualShare = 0.5;
// Radius of the Earth over that of the shell at 350 km.
constexpr double kShellRatio = 6371.0 / 6721.0;

// Correlation times, in s, of the errors of orbit and clock and of the ionosphere model.
constexpr double kOrbitCorrelation = 3600.0;
constexpr double kIonosphereCorrelation = 900.0;

// Returns 1 / sin E, bounded at the value for 5 degrees: the growth of atmospheric errors towards
// the horizon.
double obliquity(double elevation) { return 1.0 / std::max(std::sin(elevation), 0.0872); }

double ionosphere_sigma(const DelayContext& context, double elevation, double delay_m,
                        double frequency) {
  const bool is_known = context.klobuchar->valid || !context.config->has_atmosphere;
  const double share = is_known
                           ? context.config->ionosphere_model_error
                           : std::max(kUnknownModelShare, context.config->ionosphere_model_error);
  // The thin shell at 350 km limits the growth: obliquity of IS-GPS-200, at most 3.
  const double slant = std::min(obliquity(elevation), 3.0);
  const double at_zenith = is_known ? kIonosphereFloor : kUnknownFloor;
  const double floor = at_zenith * slant * ionosphere_factor(frequency);
  return std::max(share * delay_m, floor);
}

double atmosphere_variance(const DelayContext& context, const SatelliteInView& satellite) {
  if (!context.has_position) return square(kUnknownAtmosphereSigma);
  return square(context.config->troposphere_model_error_m * obliquity(satellite.elevation));
}

double frequency_of(const DelayContext& context, const SignalObservation& signal) {
  return context.config->bands.frequency_hz(signal.satellite.system, signal.code.band);
}

// Returns the delay of a pair of which CNAV gives one signal, and the older message the other.
std::optional<GroupDelay> half_cnav_delay(const DelayContext& context, SatelliteId satellite,
                                          const Ephemeris& broadcast, SignalCode first,
                                          SignalCode second) {
  const auto of_first = context.signal_biases->broadcast_delay(satellite, context.time, first);
  const auto of_second = context.signal_biases->broadcast_delay(satellite, context.time, second);
  if (!of_first && !of_second) return std::nullopt;
  const GroupDelay a = of_first ? *of_first : group_delay(broadcast, first);
  const GroupDelay b = of_second ? *of_second : group_delay(broadcast, second);
  const IonosphereFree pair = ionosphere_free(frequency_hz(satellite.system, first.band),
                                              frequency_hz(satellite.system, second.band));
  return GroupDelay{pair.gamma1 * a.delay_m + pair.gamma2 * b.delay_m,
                    std::hypot(pair.gamma1 * a.sigma_m, pair.gamma2 * b.sigma_m)};
}

// Returns the delay by CNAV or B-CNAV against the clock of the satellite's state. GPS' broadcast
// clock and those of products refer to the same pair, L1 and L2 P(Y); BeiDou's to B3I, and those of
// products to B1I and B3I.
std::optional<GroupDelay> cnav_delay(const DelayContext& context, SatelliteId satellite,
                                     const Ephemeris* broadcast, bool precise_clock,
                                     SignalCode first, SignalCode second) {
  if (context.signal_biases == nullptr) return std::nullopt;
  auto delay = context.signal_biases->broadcast_delay(satellite, context.time, first, second);
  if (!delay && broadcast != nullptr && second.is_set())
    delay = half_cnav_delay(context, satellite, *broadcast, first, second);
  if (!delay || !precise_clock || satellite.system == System::kGps) return delay;
  if (satellite.system != System::kBeidou || broadcast == nullptr) return std::nullopt;
  const GroupDelay reference = group_delay(*broadcast, {'2', 'I'}, {'6', 'I'});
  return GroupDelay{delay->delay_m - reference.delay_m,
                    std::hypot(delay->sigma_m, reference.sigma_m)};
}

// Returns the delay by the biases of the clock's product, else by the broadcast messages: of the
// older one and CNAV the one that knows it better.
GroupDelay delay_of(const DelayContext& context, const SatelliteInView& satellite,
                    const Ephemeris* broadcast, SignalCode first, SignalCode second) {
  const SatelliteId id = satellite.satellite;
  const bool precise_clock = satellite.source == OrbitSource::kPrecise || broadcast == nullptr;
  if (precise_clock && context.signal_biases != nullptr) {
    const auto delay = context.signal_biases->code_delay(id, context.time, first, second);
    if (delay) return *delay;
  }
  const GroupDelay older = precise_clock ? precise_group_delay(id.system, broadcast, first, second)
                                         : group_delay(*broadcast, first, second);
  const auto cnav = cnav_delay(context, id, broadcast, precise_clock, first, second);
  return cnav && cnav->sigma_m < older.sigma_m ? *cnav : older;
}

// Returns the part that all satellites have in common of what the model leaves in the code of
// `signal`: `sigma` on its path, and `variance` of the code. The receiver code biases,
// which are removed from the code, contain some of that part.
IonosphereError common_ionosphere_error(const DelayContext& context,
                                        const SignalObservation& signal, double elevation,
                                        double sigma, double variance) {
  const double mapping =
      ionosphere_factor(frequency_of(context, signal)) * ionosphere_slant(elevation);
  IonosphereError error;
  error.mapping = mapping;
  error.zenith_sigma = std::sqrt(1.0 - kIndividualShare) * sigma / mapping;
  error.variance = (1.0 - kIndividualShare) * variance;
  if (context.biases != nullptr)
    error.mapping -= context.biases->ionosphere_mapping(signal.satellite.system, signal.code.band);
  return error;
}

// Returns the rate of the tropospheric delay by the satellite's motion: below 1 mm/s for GNSS, some
// cm/s for a LEO satellite near the horizon. It is a central difference over one second.
double troposphere_rate(const DelayContext& context, const SatelliteInView& satellite) {
  if (!context.has_position || !context.config->has_atmosphere) return 0.0;
  const Eigen::Vector3d p_a_e = to_ecef(context.antenna);
  const auto delay_at = [&](double seconds) {
    const Eigen::Vector3d p_sat_e = satellite.p_e + seconds * satellite.v_e;
    return saastamoinen_slant_delay_m(context.antenna, look_angles(p_sat_e, p_a_e).elevation,
                                      context.time);
  };
  return delay_at(0.5) - delay_at(-0.5);
}

// Precise states are those of the centre of mass, while the signal comes from the antenna, 0.7 to
// 2.7 m nearer to the Earth depending on block and band (IGS antenna models). Unless these offsets
// are applied, a clock per system leaves some 0.7 m of them. A LEO satellite's antenna is within
// decimetres of its centre of mass.
double antenna_variance(const SatelliteInView& satellite, bool antenna_known) {
  constexpr double kAntennaOffsetSigma = 0.7;  // m
  const bool is_offset = !satellite.at_antenna && satellite.satellite.system != System::kLeo;
  return is_offset && !antenna_known ? square(kAntennaOffsetSigma) : 0.0;
}

double noise_elevation(const DelayContext& context, const SatelliteInView& satellite) {
  return context.has_position ? satellite.elevation : kHalfPi;
}

// Signals chipped at 5 or 10 MHz instead of 1 MHz have less noise and far less multipath.
bool is_wideband(System system, char band) {
  switch (system) {
    case System::kGps:
      return band == '5';
    case System::kGalileo:
      return band != '1';
    case System::kBeidou:
      return band == '5' || band == '6' || band == '7';
    case System::kLeo:
      return false;
  }
  return false;
}

double code_noise(const DelayContext& context, double elevation, const SignalObservation& signal) {
  const System system = signal.satellite.system;
  const ObservableSigma& sigma = context.config->systems[index_of(system)].sigma;
  const double factor = is_wideband(system, signal.code.band) ? sigma.wideband_code_factor : 1.0;
  return sigma.code_m * factor * noise_factor(*context.config, elevation, signal.cn0_dbhz);
}

// Returns the code minus the receiver's delay of its band.
double unbiased_range(const DelayContext& context, const SignalObservation& signal) {
  if (context.biases == nullptr) return signal.pseudorange_m;
  return signal.pseudorange_m - context.biases->offset_m(signal.satellite.system, signal.code.band);
}

double bias_variance(const DelayContext& context, const SignalObservation& signal) {
  if (context.biases == nullptr) return 0.0;
  return context.biases->variance_m2(signal.satellite.system, signal.code.band);
}

// Combines two Gauss-Markov errors into one that a long mean reduces as slowly: their spectral
// densities at zero, sigma^2 T, add. The time is that of what is not common to all satellites.
void set_correlation(double orbit_variance, double ionosphere_variance, Measurement* code) {
  const double sum = orbit_variance + ionosphere_variance;
  if (!(sum > 0.0)) return;
  code->correlated_sigma = std::sqrt(sum);
  const double own = ionosphere_variance - code->ionosphere.variance;
  code->correlation_time_s =
      (orbit_variance * kOrbitCorrelation + own * kIonosphereCorrelation) / (orbit_variance + own);
}

// Returns the displacement of the ground from its position without tides, loading and polar motion.
Eigen::Vector3d ground_displacement(const GnssConfig& config, const Eigen::Vector3d& p_e,
                                    GpsTime time, const SunMoon& bodies) {
  Eigen::Vector3d d_e = solid_earth_tide(p_e, time, bodies);
  if (config.ocean_loading) d_e += ocean_loading_displacement(p_e, time, *config.ocean_loading);
  if (config.polar_motion) d_e += pole_tide(p_e, time, *config.polar_motion);
  return d_e;
}

}  // namespace

DelayContext delay_context(const GnssConfig& config, const KlobucharModel& klobuchar, GpsTime time,
                           const Eigen::Vector3d& p_a_e) {
  DelayContext context;
  context.config = &config;
  context.klobuchar = &klobuchar;
  context.time = time;
  context.has_position = !p_a_e.isZero();
  if (!context.has_position) return context;
  context.antenna = to_geodetic(p_a_e);
  context.C_er = rotation_ecef_to_ned(context.antenna).transpose();
  const SunMoon bodies = sun_moon_positions(time);
  context.p_sun_e = bodies.sun_e;
  context.tide_e = ground_displacement(config, p_a_e, time, bodies);
  return context;
}

double ionosphere_factor(double frequency) { return square(kL1Frequency / frequency); }

double ionosphere_slant(double elevation) {
  return 1.0 / std::sqrt(1.0 - square(kShellRatio * std::cos(elevation)));
}

double ionosphere_delay_m(const DelayContext& context, const SatelliteInView& satellite,
                          double frequency) {
  if (!context.config->has_atmosphere) return 0.0;
  return klobuchar_delay_m(*context.klobuchar, context.antenna,
                           {satellite.elevation, satellite.azimuth}, context.time, frequency);
}

void set_look_angles_and_troposphere(const DelayContext& context, const Eigen::Vector3d& p_a_e,
                                     SatelliteInView* satellite) {
  if (!context.has_position) return;
  const LookAngles angles = look_angles(satellite->p_e, p_a_e);
  satellite->elevation = angles.elevation;
  satellite->azimuth = angles.azimuth;
  const ZenithDelays zenith = saastamoinen_zenith_delays(context.antenna);
  const TroposphereMapping mapping = niell_mapping(context.antenna, angles.elevation, context.time);
  satellite->troposphere_m =
      context.config->has_atmosphere
          ? zenith.hydrostatic_m * mapping.hydrostatic + zenith.wet_m * mapping.wet
          : 0.0;
  satellite->wet_mapping = mapping.wet;
  satellite->path_m = path_delay_m(context, p_a_e, *satellite);
}

Measurement code_measurement(const DelayContext& given, const SignalObservation& first,
                             const SignalObservation* second, const Ephemeris* broadcast,
                             int shared_by, SatelliteInView* satellite) {
  DelayContext context = given;
  if (second != nullptr && given.biases != nullptr &&
      given.biases->is_reference_pair(first.satellite.system, first.code.band, second->code.band))
    context.biases = nullptr;
  const double elevation = noise_elevation(context, *satellite);
  const double f1 = frequency_of(context, first);
  const double noise1 = code_noise(context, elevation, first);

  Measurement code;
  code.observable = Observable::kCode;
  code.code = first.code;
  double range = unbiased_range(context, first);
  double variance = square(noise1);  // noise and bands
  double band_variance = 0.0;
  double ionosphere = 0.0;  // variance of the model's error
  if (second != nullptr) {
    const IonosphereFree pair = ionosphere_free(f1, frequency_of(context, *second));
    code.second_code = second->code;
    range = pair.gamma1 * range + pair.gamma2 * unbiased_range(context, *second);
    const double of_first = square(pair.gamma1) * bias_variance(context, first);
    const double of_second = square(pair.gamma2) * bias_variance(context, *second);
    variance = square(combined_sigma(pair, noise1, code_noise(context, elevation, *second))) +
               of_first + of_second;
    band_variance = of_first + of_second;
  } else if (context.has_position) {
    const double delay = ionosphere_delay_m(context, *satellite, f1);
    satellite->ionosphere_l1_m = delay * square(f1 / kL1Frequency);
    range -= delay;
    band_variance = bias_variance(context, first);
    variance += band_variance;
    const double sigma = ionosphere_sigma(context, satellite->elevation, delay, f1);
    ionosphere = shared_by * square(sigma);
    code.ionosphere =
        common_ionosphere_error(context, first, satellite->elevation, sigma, ionosphere);
  }
  const GroupDelay group = delay_of(context, *satellite, broadcast, code.code, code.second_code);
  const AntennaCorrection antenna = antenna_range(context, *satellite, code.code, code.second_code);
  code.value = range + satellite->clock_m - group.delay_m - satellite->troposphere_m -
               satellite->path_m - antenna.range_m;
  const double orbit =
      square(satellite->orbit_sigma_m) + antenna_variance(*satellite, antenna.known);
  set_correlation(orbit, ionosphere, &code);
  code.sigma = std::sqrt(variance + square(group.sigma_m) + orbit + ionosphere +
                         atmosphere_variance(context, *satellite));
  code.lasting_variance = band_variance + square(group.sigma_m) + code.own_correlated_variance() +
                          atmosphere_variance(context, *satellite);
  return code;
}

CodeVariances code_variances(const DelayContext& context,
                             std::span<const SignalObservation* const> bands,
                             const SignalObservation& second, const SatelliteInView& satellite) {
  CodeVariances variances;
  if (!context.has_position || bands.empty()) return variances;
  const double elevation = satellite.elevation;
  const SignalObservation& first = *bands.front();
  const double f1 = frequency_of(context, first);
  const IonosphereFree pair = ionosphere_free(f1, frequency_of(context, second));
  variances.pair_noise = square(combined_sigma(pair, code_noise(context, elevation, first),
                                               code_noise(context, elevation, second)));
  double information = 0.0;
  for (const SignalObservation* signal : bands)
    information += 1.0 / square(code_noise(context, elevation, *signal));
  variances.single_noise = 1.0 / information;
  const double delay = ionosphere_delay_m(context, satellite, f1);
  variances.ionosphere = square(ionosphere_sigma(context, elevation, delay, f1));
  return variances;
}

Measurement doppler_measurement(const DelayContext& context, const SignalObservation& first,
                                const SignalObservation* second, const SatelliteInView& satellite) {
  const double sigma0 =
      context.config->systems[index_of(satellite.satellite.system)].sigma.doppler_m_s;
  const double elevation = noise_elevation(context, satellite);
  const double f1 = frequency_of(context, first);
  const double rate1 = -first.doppler_hz * kSpeedOfLight / f1;
  const double noise1 = sigma0 * noise_factor(*context.config, elevation, first.cn0_dbhz);

  Measurement doppler;
  doppler.observable = Observable::kDoppler;
  doppler.code = first.code;
  double rate = rate1;
  doppler.sigma = noise1;
  if (second != nullptr) {
    const double f2 = frequency_of(context, *second);
    const IonosphereFree pair = ionosphere_free(f1, f2);
    const double noise2 = sigma0 * noise_factor(*context.config, elevation, second->cn0_dbhz);
    doppler.second_code = second->code;
    rate = pair.gamma1 * rate1 - pair.gamma2 * second->doppler_hz * kSpeedOfLight / f2;
    doppler.sigma = combined_sigma(pair, noise1, noise2);
  }
  // A fast satellite clock shortens the measured range, so its drift is added back.
  doppler.value = rate + satellite.clock_drift_m_s - troposphere_rate(context, satellite);
  return doppler;
}

}  // namespace leonav
