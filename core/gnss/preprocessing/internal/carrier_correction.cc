#include "core/gnss/preprocessing/internal/carrier_correction.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/gnss/measurement/weighting.h"
#include "core/gnss/preprocessing/internal/code_correction.h"
#include "core/gnss/preprocessing/internal/path_correction.h"

namespace leonav {
namespace {

// Errors of broadcast orbits and clocks are about a metre and change within hours; those of precise
// ones are two or three centimetres and change within a quarter of a revolution.
constexpr double kBroadcastRandomWalk = 0.005;  // m/sqrt(s)
constexpr double kPreciseRandomWalk = 0.0001;   // m/sqrt(s)
constexpr double kEpochRandomWalkLeo = 0.0005;  // m/sqrt(s), from one epoch to the next
constexpr double kPreciseOrbitSigma_m = 0.02;   // each axis, LEO
// The error of the ionosphere model on a GNSS satellite's slant delay moves by a millimetre per
// second, up or down for minutes; past a LEO satellite the whole delay changes within minutes.
constexpr double kIonosphereRandomWalk = 0.01;     // m/sqrt(s)
constexpr double kIonosphereRandomWalkLeo = 0.05;  // m/sqrt(s)
// An uncorrected satellite antenna is 0.5 m beside and 1 to 2.7 m below the centre of mass. From
// the horizon to the zenith (14 degrees of nadir angle, three hours) its effect changes by some 0.1
// m.
constexpr double kAntennaRandomWalk = 0.001;  // m/sqrt(s)
// Random walk of a satellite clock against its broadcast polynomial from epoch to epoch: white
// frequency noise of 5e-12 at one second, as rubidium clocks of GPS and BeiDou have.
constexpr double kClockRandomWalk = 0.0015;  // m/sqrt(s)

// Returns how fast the line of sight to a satellite turns, rad/s.
double turning_rate(const SatelliteInView& satellite, const Eigen::Vector3d& p_a_e) {
  const Eigen::Vector3d to = satellite.p_e - p_a_e;
  return to.cross(satellite.v_e).norm() / to.squaredNorm();
}

// Returns 1 sigma of a LEO satellite's orbit error along each axis, m.
double leo_orbit_sigma_m(const SatelliteInView& satellite) {
  return satellite.source == OrbitSource::kBroadcast ? satellite.orbit_sigma_m
                                                     : kPreciseOrbitSigma_m;
}

// Returns the random walk of a LEO satellite's orbit error. Within minutes the line of sight sweeps
// over that error, which is equal in all directions and practically constant for an arc: each
// radian of motion shows the full error anew.
double leo_random_walk(const SatelliteInView& satellite, const Eigen::Vector3d& p_a_e) {
  return leo_orbit_sigma_m(satellite) * std::sqrt(turning_rate(satellite, p_a_e));
}

double orbit_random_walk(const SatelliteInView& satellite, const DelayContext& context) {
  if (satellite.satellite.system == System::kLeo) {
    return leo_random_walk(satellite, to_ecef(context.antenna));
  }
  return satellite.source == OrbitSource::kBroadcast ? kBroadcastRandomWalk : kPreciseRandomWalk;
}

}  // namespace

Measurement carrier_measurement(const DelayContext& context, const SignalObservation& first,
                                const SignalObservation* second, const CarrierStatus& status,
                                SatelliteInView* in_view) {
  const SatelliteInView& satellite = *in_view;
  const System system = satellite.satellite.system;
  const double sigma0 = context.config->systems[index_of(system)].sigma.carrier_m;
  const double f1 = context.config->bands.frequency_hz(system, first.code.band);
  const double noise1 = sigma0 * noise_factor(*context.config, satellite.elevation, first.cn0_dbhz);

  Measurement carrier;
  carrier.observable = Observable::kCarrier;
  carrier.code = first.code;
  carrier.arc = status.arc;
  double range = status.first_m - satellite.wind_up_cycles * kSpeedOfLight / f1;
  double noise = noise1;
  CarrierCycles& cycles = carrier.cycles;
  cycles.wavelength_m[0] = kSpeedOfLight / f1;
  cycles.repaired_m = status.repaired_m;
  cycles.half_cycle_unresolved = status.half_cycle_unresolved;
  double random_walk = square(orbit_random_walk(satellite, context));
  if (second != nullptr) {
    const double f2 = context.config->bands.frequency_hz(system, second->code.band);
    const IonosphereFree pair = ionosphere_free(f1, f2);
    carrier.second_code = second->code;
    const double second_m = status.second_m - satellite.wind_up_cycles * kSpeedOfLight / f2;
    cycles.wavelength_m[1] = kSpeedOfLight / f2;
    cycles.gamma = {pair.gamma1, pair.gamma2};
    cycles.geometry_free_m = range - second_m;
    cycles.geometry_free_noise = status.geometry_free_noise;
    range = pair.gamma1 * range + pair.gamma2 * second_m;
    noise = combined_sigma(
        pair, noise1,
        sigma0 * noise_factor(*context.config, satellite.elevation, second->cn0_dbhz));
  } else {
    // The ionosphere delays the code and advances the carrier by the same amount.
    in_view->carrier_ionosphere_m = ionosphere_delay_m(context, satellite, f1);
    range += in_view->carrier_ionosphere_m;
    random_walk +=
        square(system == System::kLeo ? kIonosphereRandomWalkLeo : kIonosphereRandomWalk);
  }
  const AntennaCorrection antenna =
      antenna_range(context, satellite, carrier.code, carrier.second_code);
  in_view->ionosphere_issue = context.klobuchar_issue;
  in_view->antenna_m = antenna.range_m;
  in_view->antenna_issue = antenna.issue;
  if (!antenna.known && system != System::kLeo) random_walk += square(kAntennaRandomWalk);
  carrier.value =
      range + satellite.clock_m - satellite.troposphere_m - satellite.path_m - antenna.range_m;
  // An unresolved half cycle may still come or go: a quarter of a cycle either way.
  const double half_cycle =
      status.half_cycle_unresolved ? 0.25 * kSpeedOfLight / f1 * noise / noise1 : 0.0;
  carrier.sigma = std::hypot(noise, satellite.orbit_sigma_change_m, half_cycle);
  carrier.random_walk = std::sqrt(random_walk);
  return carrier;
}

double orbit_step_m(const Ephemeris& from, const Ephemeris& to, GpsTime time,
                    const Eigen::Vector3d& p_a_e) {
  const SatelliteState before = broadcast_state(from, time);
  const SatelliteState now = broadcast_state(to, time);
  const Eigen::Vector3d line_of_sight = (now.p_e - p_a_e).normalized();
  return kSpeedOfLight * (now.clock_s - before.clock_s) - line_of_sight.dot(now.p_e - before.p_e);
}

double change_sigma_m(const CycleSlipConfig& config, const BandPlan& bands,
                      const SatelliteInView& satellite, const Measurement& carrier,
                      const Eigen::Vector3d& p_a_e, double dt) {
  const System system = satellite.satellite.system;
  const bool leo = system == System::kLeo;
  const bool broadcast = satellite.source == OrbitSource::kBroadcast;
  const double precise = leo ? kEpochRandomWalkLeo : kPreciseRandomWalk;
  const double clock = broadcast ? kClockRandomWalk : precise;
  double own = clock * std::sqrt(dt);
  // The line of sight to a LEO satellite turns over the error of its broadcast orbit.
  if (leo && broadcast) {
    own = std::hypot(own, leo_orbit_sigma_m(satellite) * turning_rate(satellite, p_a_e) * dt);
  }
  if (carrier.second_code.band != 0) return own;
  const double rate = leo ? config.ionosphere_rate_leo_m_s : config.ionosphere_rate_m_s;
  const double to_frequency =
      square(frequency_hz(System::kGps, '1') / bands.frequency_hz(system, carrier.code.band));
  return std::hypot(own, rate * to_frequency * elevation_factor(satellite.elevation) * dt);
}

}  // namespace leonav
