#include "tools/sim/signals/satellite_observer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/earth/rotation.h"
#include "core/gnss/orbits/satellite_attitude.h"
#include "core/gnss/propagation/phase_wind_up.h"
#include "core/gnss/signals/signal.h"
#include "tools/sim/scenario/random_streams.h"
#include "tools/sim/signals/signal_plan.h"
#include "tools/sim/signals/signal_strength.h"
#include "tools/sim/sky/group_delays.h"

namespace leonav::sim {

SatelliteObserver::SatelliteObserver(const ObserverWorld& world, const TrueSatellite& satellite)
    : world_(world),
      satellite_(satellite),
      tracking_(world.scenario, satellite.id),
      street_(make_street_errors(world.scenario, satellite.id)) {}

bool SatelliteObserver::is_above_mask(const EpochInstant& now) const {
  const double t = now.clock.t;
  const Eigen::Vector3d roughly_e = to_earth(satellite_.orbit.at(t).p_i, t);
  return look_angles(roughly_e, now.antenna.p_e).elevation >=
         world_.scenario.receiver.elevation_mask;
}

SatelliteObserver::Geometry SatelliteObserver::geometry(const EpochInstant& now) {
  Geometry g;
  g.path = signal_path(satellite_, now.antenna, world_.atmosphere);
  std::array<double, 4> range{}, tecu{};
  std::array<LookAngles, 4> direction;
  for (std::size_t i = 0; i < 4; ++i) {
    const SignalPath path = signal_path(satellite_, now.around[i], world_.atmosphere);
    range[i] = path.range_m;
    tecu[i] = path.tecu;
    direction[i] = path.direction;
  }
  g.rate_m_s = rate_of(range);
  g.tecu_rate = rate_of(tecu);
  const double across_s = kRateTimes[2] - kRateTimes[1];
  g.direction_rates.elevation = (direction[2].elevation - direction[1].elevation) / across_s;
  g.direction_rates.azimuth = wrap_to_pi(direction[2].azimuth - direction[1].azimuth) / across_s;
  g.reception =
      world_.surroundings.reception(now.place, satellite_.id, g.path.direction, g.direction_rates);
  if (!street_) return g;
  const double elevation = g.path.direction.elevation;
  const double turn =
      std::hypot(g.direction_rates.elevation, g.direction_rates.azimuth * std::cos(elevation));
  g.street = street_->at({now.clock.t, elevation, turn});
  return g;
}

Arrival SatelliteObserver::arrival(const EpochInstant& now, const Geometry& g,
                                   const Pull& pull) const {
  const Cn0Config& cn0 = world_.scenario.receiver.cn0;
  Arrival arrival;
  arrival.present = g.reception.possible && g.street.possible;
  arrival.loss_db = elevation_loss_db(cn0, g.path.direction.elevation) + g.reception.loss_db +
                    g.street.loss_db +
                    world_.atmosphere.ionosphere().fading_db(now.clock.t, satellite_.id);
  for (std::size_t s = 0; s < kTrackedSignals; ++s) {
    arrival.cn0_dbhz[s] = zenith_cn0_dbhz(cn0, satellite_.id.system, s) - arrival.loss_db;
  }
  arrival.slip_factor = now.place.place->slips;
  // The end of spoofing breaks the lock, as another way of the signal does.
  arrival.route = g.reception.route + g.street.route + 0x9E3779B9U * pull.breaks;
  arrival.slips = g.street.slips;
  arrival.direct = g.reception.extra_m == 0.0 && g.street.extra_m == 0.0;
  return arrival;
}

void SatelliteObserver::turn(const EpochInstant& now, const SignalPath& path) {
  const Eigen::Vector3d p_s_e = to_earth(path.satellite.p_i, now.clock.t);
  const Eigen::Vector3d v_s_e = to_earth(path.satellite.v_i, now.clock.t) -
                                Eigen::Vector3d(0.0, 0.0, kEarthRotationRate).cross(p_s_e);
  const Eigen::Matrix3d C_es = satellite_axes(
      p_s_e, v_s_e, now.bodies.sun_e, attitude_law(satellite_.id, AttitudeLaw::kOrbitNormal));
  const auto cycles = [&](const AntennaInstant& antenna) {
    return phase_wind_up_cycles(p_s_e, C_es, antenna.p_e, antenna.C_eb, wind_up_);
  };
  wind_up_ = cycles(now.antenna);
  // The satellite's own rotation is 1e-4 cycles a second or less.
  wind_up_rate_ = rate_of(
      {cycles(now.around[0]), cycles(now.around[1]), cycles(now.around[2]), cycles(now.around[3])});
}

void SatelliteObserver::observe(const EpochInstant& now, RawEpoch* raw) {
  if (!is_above_mask(now)) return tracking_.step(now.t_tag, Arrival());
  const Geometry g = geometry(now);
  const Pull pull = world_.faults.pull(satellite_.id, now.t_tag);
  Arrival arrival = this->arrival(now, g, pull);
  if (world_.faults.is_out(satellite_.id, g.path.direction.elevation, now.t_tag))
    arrival.present = false;
  turn(now, g.path);
  age_.advance(now.clock.t, g.path.direction.elevation, g.direction_rates);
  tracking_.step(now.t_tag, arrival);
  for (std::size_t s = 0; s < kTrackedSignals; ++s) {
    if (tracking_.signal(s).code) measure(now, g, arrival, pull, s, raw);
  }
}

void SatelliteObserver::measure(const EpochInstant& now, const Geometry& g, const Arrival& arrival,
                                const Pull& pull, std::size_t s, RawEpoch* raw) {
  const ReceiverConfig& receiver = world_.scenario.receiver;
  const System system = satellite_.id.system;
  const SignalTrack& track = tracking_.signal(s);
  const std::uint64_t number = signal_number(table_index_of(satellite_.id), s);
  // The noise belongs to the stamp, so that jumps of the clock do not change it.
  GaussianGenerator random =
      random_stream(world_.scenario.seed, "noise", instant_number(number, now.t_tag));
  const NoiseConfig& noise = receiver.noise[index_of(system)];
  const double factor = noise_factor(arrival.loss_db);
  const StreetSignalError& street = g.street.signals[s];
  const double code_noise_m = noise.code_m * factor * random.draw() * street.code_noise;
  const double carrier_noise_m = noise.carrier_m * factor * random.draw() * street.carrier_noise;
  const double doppler_noise_m_s =
      noise.doppler_m_s * factor * random.draw() * street.doppler_noise;
  const double scatter_db = receiver.cn0.scatter_db * random.draw();
  MultipathError reflected = world_.multipath.error(
      satellite_.id, s, g.path.direction.elevation, age_, now.place.travelled_m,
      now.place.speed_m_s, now.place.place->multipath);
  reflected.code_m += street.code_m;
  reflected.carrier_m += street.carrier_m;
  reflected.doppler_m_s += street.doppler_m_s;

  const ClockTable::Value base = world_.clock.time_base_m(system, now.clock.t);
  const double common =
      g.path.range_m + base.offset_s + g.reception.extra_m + g.street.extra_m + pull.range_m;
  const double rate = g.rate_m_s + kSpeedOfLight * now.clock.drift + base.drift +
                      g.reception.extra_m_s + g.street.extra_m_s + pull.rate_m_s;
  SignalObservation o;
  o.satellite = satellite_.id;
  o.code = signals_of(world_.scenario, system)[s];
  const double frequency = world_.scenario.bands().frequency_hz(system, o.code.band);
  const double wavelength = kSpeedOfLight / frequency, delay = delay_per_tecu_m(frequency);
  const double late_m = signal_delay_m(system, satellite_.group_delay_m, o.code.band);
  o.pseudorange_m = common + late_m + kSpeedOfLight * now.clock.code_s + delay * g.path.tecu +
                    reflected.code_m + code_noise_m;
  // Cycles are counted in seconds of the receiver's clock, which a fast oscillator makes shorter:
  // at a drift of 1e-5 the rate of a low satellite of 6 km/s is 6 cm/s smaller.
  const double receiver_seconds = 1.0 + now.clock.drift;  // per second of GPS time
  o.doppler_hz =
      -((rate - delay * g.tecu_rate + reflected.doppler_m_s + doppler_noise_m_s) / wavelength +
        wind_up_rate_) /
      receiver_seconds;
  o.cn0_dbhz = std::clamp(arrival.cn0_dbhz[s] + scatter_db, 0.0, 99.0);
  if (track.carrier) {
    o.carrier_cycles = (common + kSpeedOfLight * now.clock.carrier_s - delay * g.path.tecu +
                        reflected.carrier_m + carrier_noise_m) /
                           wavelength +
                       wind_up_ + track.cycles;
    o.lock_time_s = now.t_tag - track.locked_since;
    o.loss_of_lock = track.loss_of_lock;
    o.half_cycle_ambiguous = track.half_cycle_ambiguous;
  }
  if (raw->observations.size() == raw->observations.max_size()) {
    throw std::runtime_error("more than " + std::to_string(raw->observations.max_size()) +
                             " signals at once: more satellites in view than an epoch holds; "
                             "leave some out, or raise receiver.elevation_mask_deg");
  }
  raw->observations.push_back(o);
}

}  // namespace leonav::sim
