// Raw epochs from a forward model that shares nothing with the preprocessing but the satellites'
// own ephemerides and the delay models: light time solved in inertial space, Doppler by numerical
// differentiation of the pseudorange.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "core/earth/sun_moon.h"
#include "core/earth/tides.h"
#include "core/gnss/measurement/look_angles.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/orbits/satellite_state.h"
#include "core/gnss/propagation/ionosphere.h"
#include "core/gnss/propagation/shapiro.h"
#include "core/gnss/propagation/troposphere.h"
#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/observation.h"

namespace leonav::test {

inline const GpsTime kSkyEpoch = GpsTime::from_week_and_tow(2200, 345'600.0);

// A Walker pattern of circular-like orbits with satellite clocks that are off by up to 0.3 ms.
struct Walker {
  System system = System::kGps;
  int planes = 6;
  int per_plane = 5;
  double semi_major_axis_m = 26'560e3;
  double inclination = 0.96;  // rad
  double eccentricity = 0.008;
};

inline std::vector<Ephemeris> walker_ephemerides(const Walker& walker) {
  constexpr double kTwoPi = 6.283185307179586;
  std::vector<Ephemeris> ephemerides;
  for (int plane = 0; plane < walker.planes; ++plane) {
    for (int slot = 0; slot < walker.per_plane; ++slot) {
      const int number = plane * walker.per_plane + slot + 1;
      Ephemeris e;
      e.satellite = {walker.system, static_cast<std::uint16_t>(number)};
      if (walker.system == System::kGalileo) e.message = NavigationMessage::kGalileoInav;
      if (walker.system == System::kBeidou) e.message = NavigationMessage::kBeidouD1;
      if (walker.system == System::kBeidou) e.satellite.number += 18;  // no geostationary ones
      e.toe = kSkyEpoch;
      e.toc = kSkyEpoch;
      e.transmission_time = kSkyEpoch.plus_seconds(-3600.0);
      e.accuracy_m = 0.0;
      e.sqrt_a = std::sqrt(walker.semi_major_axis_m);
      e.eccentricity = walker.eccentricity;
      e.i0 = walker.inclination;
      e.omega0 = kTwoPi * plane / walker.planes;
      e.omega = 0.7;
      e.m0 = std::remainder(
          kTwoPi * (slot + plane / static_cast<double>(walker.planes)) / walker.per_plane, kTwoPi);
      e.omega_dot = -8.0e-9;
      e.af0 = 3.0e-4 * std::sin(1.7 * number);
      e.af1 = 1.0e-11 * std::cos(2.3 * number);
      ephemerides.push_back(e);
    }
  }
  return ephemerides;
}

inline Walker gps_walker() { return {}; }
inline Walker galileo_walker() { return {System::kGalileo, 3, 10, 29'600e3, 0.977, 0.0005}; }
inline Walker beidou_walker() { return {System::kBeidou, 3, 13, 27'906e3, 0.96, 0.0005}; }
inline Walker leo_walker() { return {System::kLeo, 13, 14, 7'478e3, 0.96, 0.001}; }

// As a product tells it: the relativistic part of the orbit's eccentricity is left to the user.
inline PreciseState product_node(const Ephemeris& ephemeris, GpsTime time) {
  const SatelliteState state = broadcast_state(ephemeris, time);
  PreciseState node;
  node.satellite = ephemeris.satellite;
  node.time = time;
  node.p_e = state.p_e;
  node.clock_s = state.clock_s + 2.0 * state.p_e.dot(state.v_e) / (kSpeedOfLight * kSpeedOfLight);
  return node;
}

struct SimulatedSky {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  std::vector<Ephemeris> ephemerides;

  void add(const Walker& walker) {
    for (const Ephemeris& e : walker_ephemerides(walker)) {
      if (ephemeris_store.add(e)) ephemerides.push_back(e);
    }
  }
};

inline SimulatedSky sky_of(std::initializer_list<Walker> walkers) {
  SimulatedSky sky;
  for (const Walker& walker : walkers) sky.add(walker);
  return sky;
}

// A receiver moving straight in ECEF, whose clock is off by `clock_s` at kSkyEpoch and drifts.
struct SimulatedReceiver {
  Eigen::Vector3d p_e = to_ecef({0.69, 0.14, 300.0});  // at kSkyEpoch
  Eigen::Vector3d v_e = Eigen::Vector3d::Zero();
  double clock_s = 0.0;
  double clock_drift = 0.0;                            // s/s
  std::vector<double> system_offset_m = {0, 0, 0, 0};  // per System
  bool atmosphere = true;
  Eigen::Vector3d tide_e = Eigen::Vector3d::Zero();  // of the ground; simulate_epoch() sets it
  double elevation_mask = 0.0873;                    // rad; satellites below are not observed
  std::vector<std::pair<SignalCode, double>> signals = {{{'1', 'C'}, 45.0}, {{'2', 'W'}, 42.0}};
};

inline Eigen::Vector3d inertial(const Eigen::Vector3d& p_e, double seconds) {
  return Eigen::AngleAxisd(kEarthRotationRate * seconds, Eigen::Vector3d::UnitZ()) * p_e;
}

// Pseudorange at true time kSkyEpoch + t of a signal on `frequency` Hz.
inline double simulated_pseudorange(const SimulatedSky& sky, const SimulatedReceiver& receiver,
                                    const Ephemeris& ephemeris, double t, double frequency) {
  const Eigen::Vector3d p_a = receiver.p_e + receiver.v_e * t + receiver.tide_e;
  SatelliteState state;
  double flight = 0.07;
  for (int i = 0; i < 8; ++i) {
    state = broadcast_state(ephemeris, kSkyEpoch.plus_seconds(t - flight));
    // Sub-nanosecond part of the instant, which GpsTime cannot hold.
    const double rounding =
        (t - flight) - seconds_between(kSkyEpoch.plus_seconds(t - flight), kSkyEpoch);
    const Eigen::Vector3d p_s = state.p_e + state.v_e * rounding;
    flight = (inertial(p_s, t - flight) - inertial(p_a, t)).norm() / kSpeedOfLight;
  }
  const Eigen::Vector3d p_s_now = inertial(state.p_e, -flight);
  double range = flight * kSpeedOfLight +
                 kSpeedOfLight * (receiver.clock_s + receiver.clock_drift * t - state.clock_s) +
                 receiver.system_offset_m[index_of(ephemeris.satellite.system)] +
                 shapiro_delay_m(p_s_now, p_a);
  if (receiver.atmosphere) {
    const LookAngles angles = look_angles(p_s_now, p_a);
    const GpsTime now = kSkyEpoch.plus_seconds(t);
    range += saastamoinen_slant_delay_m(to_geodetic(p_a), angles.elevation, now);
    range += klobuchar_delay_m(sky.ephemeris_store.klobuchar(), to_geodetic(p_a), angles, now,
                               frequency);
  }
  return range;
}

inline double simulated_elevation(const SimulatedReceiver& receiver, const Ephemeris& ephemeris,
                                  double t) {
  const SatelliteState state = broadcast_state(ephemeris, kSkyEpoch.plus_seconds(t - 0.07));
  return look_angles(state.p_e, receiver.p_e + receiver.v_e * t).elevation;
}

// The raw epoch at true time kSkyEpoch + t, free of noise; `noise(observation)` may add some.
inline RawEpoch simulate_epoch(
    const SimulatedSky& sky, const SimulatedReceiver& on_crust, double t,
    const std::function<void(SignalObservation*)>& noise = [](SignalObservation*) {}) {
  const GpsTime now = kSkyEpoch.plus_seconds(t);
  SimulatedReceiver receiver = on_crust;
  receiver.tide_e = solid_earth_tide(receiver.p_e + receiver.v_e * t, now, sun_moon_positions(now));
  RawEpoch raw;
  raw.time = kSkyEpoch.plus_seconds(t + receiver.clock_s + receiver.clock_drift * t);
  for (const Ephemeris& e : sky.ephemerides) {
    if (simulated_elevation(receiver, e, t) < receiver.elevation_mask) continue;
    for (const auto& [code, cn0] : receiver.signals) {
      const double frequency = BandPlan().frequency_hz(e.satellite.system, code.band);
      if (frequency == 0.0) continue;
      const auto range = [&](double at) {
        return simulated_pseudorange(sky, receiver, e, at, frequency);
      };
      constexpr double h = 0.05;  // five-point rule: error far below 0.1 mm/s even for LEO
      const double rate =
          (8.0 * (range(t + h) - range(t - h)) - (range(t + 2 * h) - range(t - 2 * h))) /
          (12.0 * h);
      SignalObservation observation;
      observation.satellite = e.satellite;
      observation.code = code;
      observation.pseudorange_m = range(t);
      observation.doppler_hz = -rate * frequency / kSpeedOfLight;
      observation.cn0_dbhz = cn0;
      noise(&observation);
      raw.observations.push_back(observation);
    }
  }
  return raw;
}

}  // namespace leonav::test
