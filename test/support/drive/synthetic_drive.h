// A whole drive from nothing but formulas: truth, IMU increments, raw GNSS epochs, ephemerides.
//
// The vehicle stands, sets off and drives figures of eight in the tangent plane of the start; its
// body axes stay level there and its nose points along the velocity. Position, velocity,
// acceleration and heading are closed forms of time, and the IMU's increments follow from them by
// Simpson's rule: nothing here uses the mechanization or the filter. Raw epochs are those of
// simulated_sky.h at the antenna.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "core/earth/gravity.h"
#include "core/earth/rotation.h"
#include "core/gnss/signals/band_plan.h"
#include "core/inertial/strapdown/imu.h"
#include "core/inertial/strapdown/nav_state.h"
#include "support/sky/simulated_carrier.h"
#include "support/sky/simulated_sky.h"

namespace leonav::test {

struct SyntheticDriveOptions {
  double duration_s = 120.0;  // at most 3600: the ephemerides age
  double imu_rate_hz = 200.0;
  double epoch_interval_s = 1.0;
  double first_epoch_s = 1.0;  // after the start, true time
  double standstill_s = 10.0;
  double acceleration_s = 10.0;   // from standstill to full speed
  double turn_rate_rad_s = 0.08;  // of the figure's parameter; 0.08: 8 to 11 m/s
  Geodetic start = {0.69, 0.14, 300.0};
  Eigen::Vector3d lever_arm_b = {0.4, -0.2, -1.1};
  double clock_s = 2e-5, clock_drift = 5e-8;
  bool galileo = true, beidou = false, leo = false;
  // White noise, 1 sigma; zero: none.
  double code_sigma_m = 0.0, doppler_sigma_m_s = 0.0;
  double carrier_sigma_m = -1.0;      // negative: no carriers
  double slip_probability = 0.0;      // per satellite and epoch
  double angle_random_walk = 0.0;     // rad/sqrt(s)
  double velocity_random_walk = 0.0;  // m/s/sqrt(s)
  Eigen::Vector3d gyro_bias_b = Eigen::Vector3d::Zero(), accel_bias_b = Eigen::Vector3d::Zero();
  std::uint64_t seed = 1;
};

// GPS, Galileo and BeiDou at a place where 32 of their satellites are above 15 degrees.
inline SyntheticDriveOptions full_sky(SyntheticDriveOptions options) {
  options.galileo = options.beidou = true;
  options.start = {-0.209, -1.257, 300.0};
  return options;
}

// White noise on codes, Dopplers and carriers.
inline SyntheticDriveOptions with_noise(SyntheticDriveOptions options, double code_sigma_m) {
  options.code_sigma_m = code_sigma_m;
  options.doppler_sigma_m_s = 0.05;
  options.carrier_sigma_m = 0.003;
  return options;
}

class SyntheticPath {
 public:
  explicit SyntheticPath(const SyntheticDriveOptions& options)
      : options_(options),
        p0_e_(to_ecef(options.start)),
        C_en0_(rotation_ecef_to_ned(options.start).transpose()) {}

  // Truth of the IMU `t` seconds after kSkyEpoch.
  NavState state(double t) const {
    const Figure f = figure(t);
    NavState state;
    state.time = kSkyEpoch.plus_seconds(t);
    state.p_e = p0_e_ + C_en0_ * f.p;
    state.v_e = C_en0_ * f.v;
    state.q_eb = Eigen::Quaterniond(Eigen::Matrix3d(C_en0_ * yaw_matrix(f.heading)));
    return state;
  }

  double yaw_rate(double t) const { return figure(t).heading_rate; }

  Eigen::Vector3d antenna_p_e(double t) const {
    const NavState s = state(t);
    return s.p_e + s.q_eb * options_.lever_arm_b;
  }
  Eigen::Vector3d antenna_v_e(double t) const {
    const NavState s = state(t);
    const Eigen::Vector3d omega_eb_b(0.0, 0.0, yaw_rate(t));
    return s.v_e + s.q_eb * omega_eb_b.cross(options_.lever_arm_b);
  }

  // What a perfect IMU measures over (from, to].
  ImuSample sample(GpsTime from, GpsTime to) const {
    const double a = seconds_between(from, kSkyEpoch), b = seconds_between(to, kSkyEpoch);
    const double middle = 0.5 * (a + b), dt = b - a;
    ImuSample sample;
    sample.time = to;
    sample.interval_ns = to.nanoseconds() - from.nanoseconds();
    const Eigen::Vector3d omega_ie_b = state(middle).q_eb.conjugate() * omega_ie_e();
    sample.delta_theta_b = omega_ie_b * dt;
    sample.delta_theta_b.z() += wrap_to_pi(figure(b).heading - figure(a).heading);
    const Eigen::Vector3d f_a = specific_force(a), f_m = specific_force(middle),
                          f_b = specific_force(b);
    sample.delta_velocity_b = dt / 6.0 * (f_a + 4.0 * f_m + f_b);
    return sample;
  }

 private:
  struct Figure {  // in the tangent plane, north east down
    Eigen::Vector3d p, v, a;
    double heading = 0.0, heading_rate = 0.0;
  };

  static Eigen::Vector3d omega_ie_e() { return {0.0, 0.0, kEarthRotationRate}; }
  static Eigen::Matrix3d yaw_matrix(double yaw) {
    return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }

  Figure figure(double t) const {
    constexpr double kNorth = 100.0, kEast = 50.0;  // m, half the extent of the eight
    // The parameter rests, then runs; its rate follows the smooth step 3x^2 - 2x^3.
    const double w = options_.turn_rate_rad_s, T = options_.acceleration_s;
    const double since = std::max(0.0, t - options_.standstill_s);
    const double x = std::min(1.0, since / T);
    const double u = w * (T * (x * x * x - 0.5 * x * x * x * x) + std::max(0.0, since - T));
    const double du = w * (3.0 * x * x - 2.0 * x * x * x);
    const double ddu = w * (6.0 * x - 6.0 * x * x) / T;
    const Eigen::Vector3d d1(kNorth * std::cos(u), 2.0 * kEast * std::cos(2.0 * u), 0.0);
    const Eigen::Vector3d d2(-kNorth * std::sin(u), -4.0 * kEast * std::sin(2.0 * u), 0.0);
    Figure f;
    f.p = {kNorth * std::sin(u), kEast * std::sin(2.0 * u), 0.0};
    f.v = d1 * du;
    f.a = d2 * du * du + d1 * ddu;
    f.heading = std::atan2(d1.y(), d1.x());
    f.heading_rate = (d1.x() * d2.y() - d1.y() * d2.x()) / d1.squaredNorm() * du;
    return f;
  }

  Eigen::Vector3d specific_force(double t) const {
    const Figure f = figure(t);
    const Eigen::Vector3d p_e = p0_e_ + C_en0_ * f.p;
    const Eigen::Vector3d f_e =
        C_en0_ * f.a + 2.0 * omega_ie_e().cross(C_en0_ * f.v) - gravity_e(p_e);
    return yaw_matrix(f.heading).transpose() * (C_en0_.transpose() * f_e);
  }

  SyntheticDriveOptions options_;
  Eigen::Vector3d p0_e_;
  Eigen::Matrix3d C_en0_;
};

struct SyntheticDrive {
  SyntheticDriveOptions options;
  std::vector<Ephemeris> ephemerides;
  std::vector<ImuSample> imu;    // in order of time
  std::vector<RawEpoch> epochs;  // in order of time
  std::vector<NavState> truth;   // truth[i] at imu[i].time; errors zero

  NavState truth_at(GpsTime time) const {
    return SyntheticPath(options).state(seconds_between(time, kSkyEpoch));
  }
};

inline std::vector<ImuSample> synthetic_imu(const SyntheticDriveOptions& options) {
  const SyntheticPath path(options);
  std::mt19937_64 generator(options.seed);
  std::normal_distribution<double> normal;
  const auto draw = [&](double sigma) {
    Eigen::Vector3d noise;
    for (double& component : noise) component = sigma * normal(generator);
    return noise;
  };
  std::vector<ImuSample> samples;
  const auto count = static_cast<int>(options.duration_s * options.imu_rate_hz);
  for (int i = 0; i < count; ++i) {
    ImuSample sample = path.sample(kSkyEpoch.plus_seconds(i / options.imu_rate_hz),
                                   kSkyEpoch.plus_seconds((i + 1) / options.imu_rate_hz));
    const double dt = sample.interval_s();
    sample.delta_theta_b += options.gyro_bias_b * dt;
    sample.delta_theta_b += draw(options.angle_random_walk * std::sqrt(dt));
    sample.delta_velocity_b += options.accel_bias_b * dt;
    sample.delta_velocity_b += draw(options.velocity_random_walk * std::sqrt(dt));
    samples.push_back(sample);
  }
  return samples;
}

inline std::vector<RawEpoch> synthetic_epochs(const SyntheticDriveOptions& options,
                                              const SimulatedSky& sky) {
  const SyntheticPath path(options);
  std::mt19937_64 generator(options.seed + 1);
  std::normal_distribution<double> normal;
  const auto noise = [&](SignalObservation* o) {
    o->pseudorange_m += options.code_sigma_m * normal(generator);
    o->doppler_hz += options.doppler_sigma_m_s * normal(generator) /
                     BandPlan().wavelength_m(o->satellite.system, o->code.band);
  };
  SimulatedCarriers carriers(options.carrier_sigma_m, options.slip_probability, options.seed + 2);
  std::vector<RawEpoch> epochs;
  for (int k = 0;; ++k) {
    const double t = options.first_epoch_s + k * options.epoch_interval_s;
    if (t > options.duration_s) return epochs;
    SimulatedReceiver receiver;
    receiver.v_e = path.antenna_v_e(t);
    receiver.p_e = path.antenna_p_e(t) - receiver.v_e * t;
    receiver.clock_s = options.clock_s;
    receiver.clock_drift = options.clock_drift;
    receiver.signals = {{{'1', 'C'}, 45.0}, {{'2', 'W'}, 42.0}, {{'5', 'Q'}, 44.0}};
    if (options.beidou) receiver.signals.push_back({{'6', 'I'}, 44.0});
    RawEpoch raw = simulate_epoch(sky, receiver, t);
    if (options.carrier_sigma_m >= 0.0)
      carriers.fill(sky, receiver, t, path.state(t).q_eb.toRotationMatrix(), &raw);
    for (SignalObservation& observation : raw.observations) noise(&observation);
    epochs.push_back(raw);
  }
}

inline SyntheticDrive synthetic_drive(const SyntheticDriveOptions& options = {}) {
  SyntheticDrive drive;
  drive.options = options;
  SimulatedSky sky;
  sky.add(gps_walker());
  if (options.galileo) sky.add(galileo_walker());
  if (options.beidou) sky.add(beidou_walker());
  if (options.leo) sky.add(leo_walker());
  drive.ephemerides = sky.ephemerides;
  drive.imu = synthetic_imu(options);
  drive.epochs = synthetic_epochs(options, sky);
  for (const ImuSample& sample : drive.imu) drive.truth.push_back(drive.truth_at(sample.time));
  return drive;
}

inline double heading_at(const SyntheticDrive& drive, double t) {
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(drive.options.start);
  return euler_from_rotation(C_ne * SyntheticPath(drive.options).state(t).q_eb.toRotationMatrix())
      .yaw;
}

// Calls on_ephemeris(e), on_imu(sample) and on_epoch(raw) in the order in which a live system would
// receive them: ephemerides first, each epoch `latency_s` after its time.
template <typename OnEphemeris, typename OnImu, typename OnEpoch>
void feed(const SyntheticDrive& drive, double latency_s, OnEphemeris on_ephemeris, OnImu on_imu,
          OnEpoch on_epoch) {
  for (const Ephemeris& ephemeris : drive.ephemerides) on_ephemeris(ephemeris);
  std::size_t next = 0;
  for (const ImuSample& sample : drive.imu) {
    on_imu(sample);
    while (next < drive.epochs.size() &&
           drive.epochs[next].time.plus_seconds(latency_s) <= sample.time) {
      on_epoch(drive.epochs[next++]);
    }
  }
}

}  // namespace leonav::test
