// Synthetic satellites, measurements and IMU for the filter's tests. Everything drawn comes from
// one generator of our own, so that every machine draws the same.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/earth/ellipsoid.h"
#include "core/earth/gravity.h"
#include "core/earth/rotation.h"
#include "core/filter/ekf.h"
#include "core/gnss/measurement/range_model.h"

namespace leonav::synthetic {

// SplitMix64 and the polar method.
class Generator {
 public:
  // Seeds that follow each other must not give the same sequence shifted: the start is hashed.
  explicit Generator(std::uint64_t seed) : state_(seed) { state_ = bits() ^ (seed << 32); }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double normal() {
    while (true) {
      const double a = 2.0 * uniform() - 1.0;
      const double b = 2.0 * uniform() - 1.0;
      const double s = a * a + b * b;
      if (s > 0.0 && s < 1.0) return a * std::sqrt(-2.0 * std::log(s) / s);
    }
  }
  Eigen::Vector3d normal3() {
    Eigen::Vector3d v;
    for (int i = 0; i < 3; ++i) v(i) = normal();
    return v;
  }

 private:
  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

inline const GpsTime kStart = GpsTime::from_week_and_tow(2300, 100'000.0);

inline Eigen::Vector3d start_position() {
  return to_ecef({.latitude = 0.83, .longitude = 0.2, .height = 300.0});
}

inline Eigen::Matrix3d C_en_at(const Eigen::Vector3d& p_e) {
  return rotation_ecef_to_ned(to_geodetic(p_e)).transpose();
}

inline SatelliteInView satellite_at(System system, std::uint16_t number, double azimuth,
                                    double elevation) {
  const Eigen::Matrix3d C_en = C_en_at(start_position());
  const Eigen::Vector3d u{std::cos(elevation) * std::cos(azimuth),
                          std::cos(elevation) * std::sin(azimuth), -std::sin(elevation)};
  const Eigen::Vector3d across{-std::sin(azimuth), std::cos(azimuth), 0.3};
  SatelliteInView view;
  view.satellite = {system, number};
  view.p_e = start_position() + C_en * u * 2.2e7;
  view.v_e = C_en * across * 3000.0;
  view.azimuth = azimuth;
  view.elevation = elevation;
  return view;
}

// Five GPS and three Galileo satellites, well spread.
inline std::vector<SatelliteInView> eight_satellites() {
  std::vector<SatelliteInView> sky;
  constexpr std::array<double, 8> kAzimuth = {0.1, 1.3, 2.4, 3.6, 5.0, 0.8, 2.9, 4.4};
  constexpr std::array<double, 8> kElevation = {0.4, 1.2, 0.5, 0.9, 0.35, 0.7, 0.6, 1.0};
  for (std::size_t i = 0; i < 8; ++i)
    sky.push_back(satellite_at(i < 5 ? System::kGps : System::kGalileo,
                               static_cast<std::uint16_t>(i + 1), kAzimuth[i], kElevation[i]));
  return sky;
}

struct Truth {
  Eigen::Vector3d p_antenna_e = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_antenna_e = Eigen::Vector3d::Zero();
  ClockState clocks;
};

// Code and Doppler of every satellite with white noise (sigma 0: none).
inline MeasurementEpoch measure(GpsTime time, const std::vector<SatelliteInView>& sky,
                                const Truth& truth, double sigma_code, double sigma_doppler,
                                Generator* noise) {
  MeasurementEpoch epoch;
  epoch.time = time;
  for (const SatelliteInView& view : sky) {
    const auto index = static_cast<std::uint16_t>(epoch.satellites.size());
    const auto base = static_cast<Eigen::Index>(index_of(view.satellite.system));
    epoch.satellites.push_back(view);
    Measurement code;
    code.satellite_index = index;
    code.observable = Observable::kCode;
    code.sigma = sigma_code;
    code.value = predict_range(view, truth.p_antenna_e).range_m + truth.clocks.offset_m(base);
    code.value += sigma_code * noise->normal();
    epoch.measurements.push_back(code);
    Measurement doppler = code;
    doppler.observable = Observable::kDoppler;
    doppler.sigma = sigma_doppler;
    doppler.value = predict_range_rate(view, truth.p_antenna_e, truth.v_antenna_e).range_rate_m_s +
                    truth.clocks.drift_m_s(base);
    doppler.value += sigma_doppler * noise->normal();
    epoch.measurements.push_back(doppler);
  }
  return epoch;
}

// A point solution around the truth with errors drawn from its own covariance.
inline PointSolution point_near(const Truth& truth, double sigma_p, double sigma_v,
                                Generator* noise) {
  PointSolution point;
  point.status = PointStatus::kOk;
  point.has_velocity = true;
  point.p_e = truth.p_antenna_e + sigma_p * noise->normal3();
  point.v_e = truth.v_antenna_e + sigma_v * noise->normal3();
  point.covariance_p_e = sigma_p * sigma_p * Eigen::Matrix3d::Identity();
  point.covariance_v_e = sigma_v * sigma_v * Eigen::Matrix3d::Identity();
  point.clock_m.fill(kNotMeasured);
  point.clock_drift_m_s.fill(kNotMeasured);
  for (const System system : {System::kGps, System::kGalileo}) {
    const auto base = static_cast<Eigen::Index>(index_of(system));
    point.clock_m[index_of(system)] = truth.clocks.offset_m(base) + sigma_p * noise->normal();
    point.clock_drift_m_s[index_of(system)] =
        truth.clocks.drift_m_s(base) + sigma_v * noise->normal();
  }
  return point;
}

// Receiver clocks drawn from `model`: one oscillator, two bases.
inline void advance_clocks(const ClockModel& model, double dt, ClockState* clocks,
                           Generator* noise) {
  // White drift noise integrated over dt: offset and drift parts with correlation sqrt(3)/2.
  const double a = noise->normal();
  const double b = noise->normal();
  const double drift = model.drift_noise * std::sqrt(dt) * a;
  const double offset =
      model.drift_noise * std::sqrt(dt * dt * dt / 3.0) * (std::sqrt(0.75) * a + 0.5 * b) +
      model.offset_noise * std::sqrt(dt) * noise->normal();
  for (Eigen::Index base = 0; base < 4; ++base) {
    clocks->offset_m(base) += dt * clocks->drift_m_s(base) + offset;
    clocks->offset_m(base) += model.inter_system_noise * std::sqrt(dt) * noise->normal();
    clocks->drift_m_s(base) += drift;
    clocks->drift_m_s(base) += model.inter_system_drift_noise * std::sqrt(dt) * noise->normal();
  }
}

// A vehicle's sway: yaw rate and forward acceleration over time.
struct Maneuver {
  double yaw_rate = 0.0;      // rad/s
  double acceleration = 0.0;  // m/s^2, forward
};

// The error-free sample that moves `truth` by the manoeuvre over `dt`.
inline ImuSample ideal_sample(const NavState& truth, const Maneuver& maneuver, double dt) {
  const Eigen::Matrix3d C_eb = truth.q_eb.toRotationMatrix();
  const Eigen::Vector3d omega_ie{0.0, 0.0, kEarthRotationRate};
  const Eigen::Vector3d v_b = C_eb.transpose() * truth.v_e;
  const Eigen::Vector3d rate_b{0.0, 0.0, maneuver.yaw_rate};
  const Eigen::Vector3d a_b = Eigen::Vector3d{maneuver.acceleration, 0.0, 0.0} + rate_b.cross(v_b);
  const Eigen::Vector3d f_b =
      a_b - C_eb.transpose() * (gravity_e(truth.p_e) - 2.0 * omega_ie.cross(truth.v_e));
  ImuSample sample;
  sample.interval_ns = std::llround(dt * 1e9);
  sample.time = truth.time.plus_nanoseconds(sample.interval_ns);
  sample.delta_theta_b = dt * (rate_b + C_eb.transpose() * omega_ie);
  sample.delta_velocity_b = dt * f_b;
  return sample;
}

inline ImuErrors draw_errors(const ImuErrorModel& model, Generator* noise) {
  ImuErrors errors;
  errors.gyro_bias_b = model.gyro_bias.sigma * noise->normal3();
  errors.accel_bias_b = model.accel_bias.sigma * noise->normal3();
  errors.gyro_scale = model.gyro_scale.sigma * noise->normal3();
  errors.accel_scale = model.accel_scale.sigma * noise->normal3();
  return errors;
}

inline void advance_errors(const ImuErrorModel& model, double dt, ImuErrors* errors,
                           Generator* noise) {
  const auto step = [&](const GaussMarkov& process, Eigen::Vector3d* value) {
    const double r = std::exp(-dt / process.correlation_time_s);
    *value = r * *value + process.sigma * std::sqrt(1.0 - r * r) * noise->normal3();
  };
  step(model.gyro_bias, &errors->gyro_bias_b);
  step(model.accel_bias, &errors->accel_bias_b);
  step(model.gyro_scale, &errors->gyro_scale);
  step(model.accel_scale, &errors->accel_scale);
}

// measured = (1 + scale) true + bias + noise
inline ImuSample with_errors(const ImuSample& ideal, const ImuErrorModel& model,
                             const ImuErrors& errors, Generator* noise) {
  ImuSample sample = ideal;
  const double dt = ideal.interval_s();
  sample.delta_theta_b =
      (1.0 + errors.gyro_scale.array()).matrix().cwiseProduct(ideal.delta_theta_b);
  sample.delta_theta_b += dt * errors.gyro_bias_b;
  sample.delta_theta_b += model.angle_random_walk * std::sqrt(dt) * noise->normal3();
  sample.delta_velocity_b =
      (1.0 + errors.accel_scale.array()).matrix().cwiseProduct(ideal.delta_velocity_b);
  sample.delta_velocity_b += dt * errors.accel_bias_b;
  sample.delta_velocity_b += model.velocity_random_walk * std::sqrt(dt) * noise->normal3();
  return sample;
}

// A MEMS unit of the better kind.
inline ImuErrorModel mems() {
  ImuErrorModel model;
  model.angle_random_walk = 0.15 / 60.0 * M_PI / 180.0;  // 0.15 deg/sqrt(h)
  model.velocity_random_walk = 0.05 / 60.0;
  model.gyro_bias = {20.0 / 3600.0 * M_PI / 180.0, 3600.0};
  model.accel_bias = {0.02, 3600.0};
  model.gyro_scale = {1e-3, 10'000.0};
  model.accel_scale = {1e-3, 10'000.0};
  return model;
}

}  // namespace leonav::synthetic
