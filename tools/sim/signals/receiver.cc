#include "tools/sim/signals/receiver.h"

#include <algorithm>
#include <cmath>

#include "core/earth/sun_moon.h"
#include "core/earth/tides.h"
#include "core/gnss/phase_wind_up.h"
#include "core/gnss/satellite_attitude.h"
#include "core/gnss/signal.h"
#include "tools/sim/scenario/random_streams.h"
#include "tools/sim/signals/signal_plan.h"

namespace leonav::sim {
namespace {

ClockTable receiver_clock(const Scenario& scenario) {
  ClockErrors errors;
  errors.offset_s = scenario.receiver.clock_offset_s;
  errors.drift = scenario.receiver.clock_drift;
  errors.drift_walk = scenario.receiver.clock_drift_walk;
  return ClockTable(-10.0, scenario.duration_s + 10.0, 1.0, errors,
                    random_stream(scenario.seed, "receiver clock"));
}

// Noise grows towards the horizon as the sine of the elevation falls; C/N0 with it.
double noise_factor_at(double elevation) { return 1.0 / std::max(std::sin(elevation), 0.1); }
double cn0_dbhz(double elevation) { return 36.0 + 14.0 * std::sqrt(std::sin(elevation)); }

}  // namespace

Receiver::Receiver(const Scenario& scenario, const SplineMotion& motion, const TrueSky& sky)
    : scenario_(scenario),
      motion_(motion),
      sky_(sky),
      atmosphere_(scenario),
      clock_(receiver_clock(scenario)) {
  GaussianGenerator random = random_stream(scenario.seed, "inter-system");
  for (double& offset : system_offset_m_) offset = 5.0 * random.draw();
  for (const TrueSatellite& satellite : sky.satellites) {
    tracks_.emplace_back();
    tracks_.back().random = random_stream(scenario.seed, "noise", place_of(satellite.id));
  }
}

// With the receiver's clock.
double Receiver::common_range_m(const TrueSatellite& satellite, double t,
                                const Eigen::Vector3d& tide_e, double* tecu) const {
  const AntennaInstant antenna = antenna_at(motion_, scenario_.receiver.lever_arm_b, tide_e, t);
  const SignalPath path = signal_path(satellite, antenna, atmosphere_);
  *tecu = path.tecu;
  return path.range_m + kSpeedOfLight * clock_.at(t).offset_s;
}

RawEpoch Receiver::epoch(double t_tag) {
  RawEpoch raw;
  raw.time = scenario_.start.plus_seconds(t_tag);
  double t = t_tag - clock_.at(t_tag).offset_s;
  t = t_tag - clock_.at(t).offset_s;
  const GpsTime now = scenario_.start.plus_seconds(t);
  const Eigen::Vector3d p_e = motion_.at(t).p_e;
  const Eigen::Vector3d tide_e = solid_earth_tide(p_e, now, sun_moon_positions(now));
  for (std::size_t i = 0; i < sky_.satellites.size(); ++i) observe(i, t, tide_e, &raw);
  return raw;
}

void Receiver::observe(std::size_t index, double t, const Eigen::Vector3d& tide_e, RawEpoch* raw) {
  const TrueSatellite& satellite = sky_.satellites[index];
  Track& track = tracks_[index];
  const AntennaInstant antenna = antenna_at(motion_, scenario_.receiver.lever_arm_b, tide_e, t);
  const Eigen::Vector3d roughly_e = to_earth(satellite.orbit.at(t).p_i, t);
  if (look_angles(roughly_e, antenna.p_e).elevation < scenario_.receiver.elevation_mask) {
    track.tracked = false;
    return;
  }
  const System system = satellite.id.system;
  const SignalPath path = signal_path(satellite, antenna, atmosphere_);
  // Five-point rule: its error is far below 0.1 mm/s even for LEO.
  constexpr double h = 0.05;
  double tecu[4], range[4];
  for (int i = 0; i < 4; ++i) {
    const double at = t + h * (i < 2 ? i - 2 : i - 1);
    range[i] = common_range_m(satellite, at, tide_e, &tecu[i]);
  }
  const auto rate = [](const double* v) {
    return (8.0 * (v[2] - v[1]) - (v[3] - v[0])) / (12.0 * h);
  };

  const Eigen::Vector3d p_s_e = to_earth(path.satellite.p_i, t);
  const Eigen::Vector3d v_s_e =
      to_earth(path.satellite.v_i, t) - Eigen::Vector3d(0.0, 0.0, kEarthRotationRate).cross(p_s_e);
  const Eigen::Matrix3d C_es =
      satellite_axes(p_s_e, v_s_e, sun_moon_positions(raw->time).sun_e,
                     attitude_law(satellite.id, AttitudeLaw::kOrbitNormal));
  track.wind_up = phase_wind_up_cycles(p_s_e, C_es, antenna.p_e, antenna.C_eb, track.wind_up);
  if (!track.tracked) {
    track.tracked = true;
    track.locked_since = t;
    for (double& cycles : track.cycles) cycles = std::round(1e5 * track.random.draw());
  }
  const NoiseConfig& noise = scenario_.receiver.noise[index_of(system)];
  const double factor = noise_factor_at(path.direction.elevation);
  const double common =
      path.range_m + kSpeedOfLight * clock_.at(t).offset_s + system_offset_m_[index_of(system)];
  const auto signals = signals_of(system);
  for (std::size_t s = 0; s < signals.size(); ++s) {
    const double frequency = frequency_hz(system, signals[s].band);
    const double wavelength = kSpeedOfLight / frequency, delay = delay_per_tecu_m(frequency);
    SignalObservation o;
    o.satellite = satellite.id;
    o.code = signals[s];
    const double late_m = signal_delay_m(system, satellite.group_delay_m, signals[s].band);
    o.pseudorange_m =
        common + late_m + delay * path.tecu + noise.code_m * factor * track.random.draw();
    o.carrier_cycles =
        (common - delay * path.tecu + noise.carrier_m * factor * track.random.draw()) / wavelength +
        track.wind_up + track.cycles[s];
    o.doppler_hz =
        -(rate(range) - delay * rate(tecu) + noise.doppler_m_s * factor * track.random.draw()) /
        wavelength;
    o.cn0_dbhz = cn0_dbhz(path.direction.elevation) + track.random.draw();
    o.lock_time_s = t - track.locked_since;
    raw->observations.push_back(o);
  }
}

}  // namespace leonav::sim
