#include "core/filter/ekf.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/gravity.h"
#include "core/earth/rotation.h"
#include "core/filter/process/constant_velocity.h"
#include "core/filter/state/ambiguities.h"
#include "core/filter/state/clock_model.h"
#include "core/filter/update/measurement_model.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSubBlock = 0.0245;       // s; the covariance moves once per so much IMU data
constexpr double kUnknownVelocity = 50.0;  // m/s, 1 sigma where the point solution has none
constexpr double kUnknownDrift = 300.0;    // m/s, 1 sigma: an oscillator off by 1 ppm

double gauss_markov_decay(const GaussMarkov& process, double dt) {
  return std::exp(-dt / process.correlation_time_s);
}

// Errors of roll, pitch and yaw as a rotation of the body in n, first order.
Matrix3d rotation_from_rpy_errors(const Matrix3d& C_nb) {
  const EulerAngles angles = euler_from_rotation(C_nb);
  const Matrix3d yaw = rotation_from_euler({0.0, 0.0, angles.yaw});
  Matrix3d J;
  J << C_nb.col(0), yaw.col(1), Vector3d::UnitZ();
  return J;
}

// From the IMU's error to the antenna's (direction 1) or back (-1): what attitude and gyro errors
// move the arm by.
EkfCovariance to_antenna(const AntennaMotion& arm, double direction, Eigen::Index states) {
  EkfCovariance T = EkfCovariance::Identity(states, states);
  T.block<3, 3>(kPosition, kAttitude) = direction * arm.d_p_d_attitude;
  T.block<3, 3>(kVelocity, kAttitude) = direction * arm.d_v_d_attitude;
  T.block<3, 3>(kVelocity, kGyroBias) = direction * arm.d_v_d_gyro_bias;
  T.block<3, 3>(kVelocity, kGyroScale) = direction * arm.d_v_d_gyro_scale;
  if (arm.estimated) {
    T.block<3, kAntennaConstants>(kPosition, kSize + kLeverArm) = direction * arm.d_p_d_constants;
    T.block<3, kAntennaConstants>(kVelocity, kSize + kLeverArm) = direction * arm.d_v_d_constants;
  }
  return T;
}

}  // namespace

Ekf::Ekf(const EkfConfig& config, const ImuErrorModel& imu, const Vector3d& lever_arm_b)
    : config_(config), imu_(imu), lever_arm_b_(lever_arm_b) {}

void Ekf::reset() {
  reset_vehicle_constants();
  initialize(GpsTime(), PointSolution());
  last_sample_ = ImuSample();
  measured_rate_b_.setZero();
  acceleration_e_.setZero();
  known_clocks_ = ClockFlags{};
  initialized_ = false;
}

void Ekf::initialize(GpsTime time, const PointSolution& point) {
  const VehicleConstants vehicle = state_.vehicle, variances = vehicle_variances();
  state_ = FilterState{};
  state_.nav.time = time;
  state_.nav.p_e = point.p_e;
  if (config_.vertical_arm) state_.nav.p_e -= vertical_arm_e(point.p_e);
  const bool moves = !config_.static_point;
  state_.nav.v_e = moves && point.has_velocity ? point.v_e : Vector3d::Zero();
  known_clocks_ = ClockFlags{};
  start_vehicle_constants(vehicle, variances);
  covariance_(kWetDelay, kWetDelay) = square(config_.wet_delay_sigma_m);
  covariance_.block<3, 3>(kPosition, kPosition) = point.covariance_p_e;
  if (moves) {
    covariance_.block<3, 3>(kVelocity, kVelocity) =
        point.has_velocity ? point.covariance_v_e
                           : Matrix3d(square(kUnknownVelocity) * Matrix3d::Identity());
  }
  const double clock_sigma = 10.0 + 3.0 * std::sqrt(point.covariance_p_e.trace());
  const double drift_sigma = 1.0 + 3.0 * std::sqrt(point.covariance_v_e.trace());
  for (std::size_t base = 0; base < kMaxTimeBases; ++base) {
    if (!std::isfinite(point.clock_m[base])) continue;
    start_clock_offset(base, point.clock_m[base], clock_sigma, &state_.clocks, &covariance_);
    known_clocks_.offset[base] = true;
    const bool has_drift = point.has_velocity && std::isfinite(point.clock_drift_m_s[base]);
    start_clock_drift(base, has_drift ? point.clock_drift_m_s[base] : 0.0,
                      has_drift ? drift_sigma : kUnknownDrift, &state_.clocks, &covariance_);
    known_clocks_.drift[base] = true;
  }
  last_update_ = time;
  code_weighting_.clear();
  new_arcs_until_ = frequent_arc_breaks_until_ = GpsTime();
  measurements_.clear();
  process_.continuous = false;
  ranges_inconsistent_ = doppler_inconsistent_ = false;
  last_consistent_time_ = GpsTime();
  pending_inter_system_step_m_ = {};
  epochs_without_accepted_code_ = {};
  has_attitude_ = false;
  initialized_ = true;
}

void Ekf::set_state(const FilterState& state, bool has_attitude, const ImuSample& last_sample) {
  state_ = state;
  has_attitude_ = has_attitude;
  initialized_ = true;
  const Eigen::Index states =
      state.first_ambiguity() + static_cast<Eigen::Index>(state.ambiguities.size());
  covariance_.setZero(states, states);
  begin_process();
  last_sample_ = last_sample;
  if (last_sample.interval_ns > 0)
    measured_rate_b_ = last_sample.delta_theta_b / last_sample.interval_s();
  mechanization_.reset(state.nav, last_sample);
}

void Ekf::set_attitude(const Eigen::Quaterniond& q_eb, const Vector3d& sigma_rpy,
                       const Vector3d& gyro_bias_b, double gyro_bias_sigma) {
  ImuErrors errors;
  errors.gyro_bias_b = gyro_bias_b;
  ImuErrorCovariance covariance = ImuErrorCovariance::Zero();
  covariance.diagonal() << Vector3d::Constant(square(gyro_bias_sigma)),
      Vector3d::Constant(square(imu_.accel_bias.sigma)),
      Vector3d::Constant(square(imu_.gyro_scale.sigma)),
      Vector3d::Constant(square(imu_.accel_scale.sigma));
  set_attitude(q_eb, sigma_rpy, errors, covariance);
}

// What was there of attitude and IMU errors is forgotten, with its correlations.
void Ekf::set_attitude(const Eigen::Quaterniond& q_eb, const Vector3d& sigma_rpy,
                       const ImuErrors& errors, const ImuErrorCovariance& covariance) {
  const AntennaMotion before = antenna();
  EkfCovariance P = covariance_;
  if (has_attitude_) {
    const EkfCovariance T = to_antenna(before, 1.0, covariance_.rows());
    P = T * covariance_ * T.transpose();
  }
  P.middleRows<kInsSize - kAttitude>(kAttitude).setZero();
  P.middleCols<kInsSize - kAttitude>(kAttitude).setZero();
  P.block<12, 12>(kGyroBias, kGyroBias) = covariance;
  state_.nav.errors = errors;
  apply_attitude(before, q_eb, sigma_rpy, P);
}

void Ekf::replace_attitude(const Eigen::Quaterniond& q_eb, const Vector3d& sigma_rpy) {
  if (!has_attitude_) return;
  const AntennaMotion before = antenna();
  const EkfCovariance T = to_antenna(before, 1.0, covariance_.rows());
  EkfCovariance P = T * covariance_ * T.transpose();
  P.middleRows<3>(kAttitude).setZero();
  P.middleCols<3>(kAttitude).setZero();
  apply_attitude(before, q_eb, sigma_rpy, P);
}

// `of_antenna` is the covariance with position and velocity of the antenna, its attitude empty.
void Ekf::apply_attitude(const AntennaMotion& before, const Eigen::Quaterniond& q_eb,
                         const Vector3d& sigma_rpy, const EkfCovariance& of_antenna) {
  state_.nav.q_eb = q_eb.normalized();
  state_.nav.p_e.setZero();
  state_.nav.v_e.setZero();
  AntennaMotion arm = antenna_motion(state_.nav, measured_rate_b_, lever_arm_b_, true,
                                     state_.vehicle, acceleration_e_);
  state_.nav.p_e = before.p_e - arm.p_e;
  state_.nav.v_e = before.v_e - arm.v_e;
  if (arm.estimated) {
    // The arm alone stood still; the antenna goes on while the IMU is late.
    state_.nav.p_e += arm.time_offset_s * before.v_e;
    arm.d_p_d_constants.rightCols<1>() = -before.v_e;
  }

  EkfCovariance P = of_antenna;
  const Matrix3d C_en = rotation_ecef_to_ned(to_geodetic(before.p_e)).transpose();
  const Matrix3d J =
      C_en * rotation_from_rpy_errors(C_en.transpose() * state_.nav.q_eb.toRotationMatrix());
  P.block<3, 3>(kAttitude, kAttitude) = J * sigma_rpy.cwiseAbs2().asDiagonal() * J.transpose();
  const EkfCovariance T = to_antenna(arm, -1.0, P.rows());
  covariance_.noalias() = T * P * T.transpose();
  has_attitude_ = true;
  process_.continuous = false;
  last_consistent_time_ = GpsTime();
}

void Ekf::predict(std::span<const ImuSample> block, GpsTime time, SpeedHistory* speeds) {
  if (!initialized_) {
    if (!block.empty() && block.back().interval_ns > 0) {
      last_sample_ = block.back();
      measured_rate_b_ = last_sample_.delta_theta_b / last_sample_.interval_s();
    }
    return;
  }
  const GpsTime start = state_.nav.time;
  if (has_attitude_) {
    mechanization_.continue_from(state_.nav);
    begin_sub_block();
  }
  for (const ImuSample& sample : block) {
    if (sample.interval_ns <= 0 || sample.time > time) continue;
    if (sample.time <= state_.nav.time) continue;  // already behind us
    if (has_attitude_)
      predict_sample(sample);
    else
      measured_rate_b_ = sample.delta_theta_b / sample.interval_s();
    last_sample_ = sample;
    if (speeds != nullptr && has_attitude_) speeds->add(state_, measured_rate_b_);
  }
  if (time > state_.nav.time) predict_imu_gap(time, ImuSample{});
  if (has_attitude_) finish_sub_block();

  const double dt = seconds_between(state_.nav.time, start);
  if (dt <= 0.0) return;
  state_.nav.errors.gyro_bias_b *= gauss_markov_decay(imu_.gyro_bias, dt);
  state_.nav.errors.accel_bias_b *= gauss_markov_decay(imu_.accel_bias, dt);
  state_.nav.errors.gyro_scale *= gauss_markov_decay(imu_.gyro_scale, dt);
  state_.nav.errors.accel_scale *= gauss_markov_decay(imu_.accel_scale, dt);
  state_.clocks.offset_m += dt * state_.clocks.drift_m_s;
  for (EkfCovariance* covariance : covariance_and_noise()) {
    propagate_clocks(config_.clock, known_clocks_, dt, covariance);
    propagate_ambiguities(state_.ambiguities, dt, covariance);
    for (int i = 0; i < static_cast<int>(state_.vehicle.size()); ++i)
      (*covariance)(kSize + i, kSize + i) +=
          square(config_.vehicle.random_walk[static_cast<std::size_t>(i)]) * dt;
    if (config_.wet_delay_sigma_m > 0.0)
      (*covariance)(kWetDelay, kWetDelay) += square(config_.wet_delay_noise) * dt;
    if (config_.use_carrier)
      (*covariance)(kCarrierClock, kCarrierClock) += square(config_.carrier_clock_noise) * dt;
  }
  if (process_.continuous)
    process_.transition.middleRows<4>(kClock) +=
        dt * process_.transition.middleRows<4>(kClockDrift);
}

void Ekf::predict_sample(const ImuSample& sample) {
  if (sample.start() > state_.nav.time) predict_imu_gap(sample.start(), sample);
  advance(sample.start() < state_.nav.time ? split(sample, state_.nav.time).after : sample);
}

void Ekf::advance(const ImuSample& sample) {
  const Matrix3d C_before = state_.nav.q_eb.toRotationMatrix();
  const Vector3d v_before_e = state_.nav.v_e;
  mechanization_.advance(sample);
  state_.nav = mechanization_.state();
  update_mean_acceleration(v_before_e, sample.interval_s());
  measured_rate_b_ = sample.delta_theta_b / sample.interval_s();
  transition_.add({.C_eb = 0.5 * (C_before + state_.nav.q_eb.toRotationMatrix()),
                   .f_b = mechanization_.specific_force_b(),
                   .omega_ib_b = mechanization_.omega_ib_b(),
                   .interval_s = sample.interval_s()});
  if (transition_.duration_s() >= kSubBlock) finish_sub_block();
}

void Ekf::inflate_attitude_noise(double noise, double seconds) {
  state_.random_walk = {noise, state_.nav.time.plus_seconds(seconds)};
}

void Ekf::begin_sub_block() {
  ImuErrorModel imu = imu_;
  if (state_.random_walk.noise > 0.0 && state_.nav.time < state_.random_walk.until)
    imu.angle_random_walk = std::hypot(imu.angle_random_walk, state_.random_walk.noise);
  transition_.begin(imu, state_.nav.errors, gravity_gradient_e(state_.nav.p_e));
}

void Ekf::finish_sub_block() {
  for (EkfCovariance* covariance : covariance_and_noise()) transition_.propagate(covariance);
  if (process_.continuous) transition_.advance(&process_.transition);
  begin_sub_block();
}

// A short hole is a sample that was not measured and is less certain for it.
void Ekf::predict_imu_gap(GpsTime time, const ImuSample& next) {
  const auto gap_fill =
      has_attitude_ ? fill_imu_gap(last_sample_, state_.nav.time, time, next) : std::nullopt;
  if (!gap_fill) return coast(time);
  last_consistent_time_ = GpsTime();
  advance(gap_fill->filler);
  finish_sub_block();
  const Matrix3d C_eb = state_.nav.q_eb.toRotationMatrix();
  const double half = 0.5 * gap_fill->filler.interval_s();
  const Matrix3d V = C_eb * gap_fill->sigma_velocity_b.cwiseAbs2().asDiagonal() * C_eb.transpose();
  for (EkfCovariance* covariance : covariance_and_noise()) {
    covariance->block<3, 3>(kPosition, kPosition) += half * half * V;
    covariance->block<3, 3>(kPosition, kVelocity) += half * V;
    covariance->block<3, 3>(kVelocity, kPosition) += half * V;
    covariance->block<3, 3>(kVelocity, kVelocity) += V;
    covariance->block<3, 3>(kAttitude, kAttitude) +=
        C_eb * gap_fill->sigma_theta_b.cwiseAbs2().asDiagonal() * C_eb.transpose();
  }
}

// Nothing is known of the motion: it goes on as before, give or take the acceleration and turning
// of the configuration. Biases and scales keep their variances, which are stationary.
void Ekf::coast(GpsTime time) {
  if (has_attitude_) {
    last_consistent_time_ = GpsTime();
    finish_sub_block();
  }
  acceleration_e_.setZero();
  const double dt = seconds_between(time, state_.nav.time);
  if (config_.static_point) {
    state_.nav.time = time;
    return;
  }
  for (EkfCovariance* covariance : covariance_and_noise())
    propagate_constant_velocity(state_.nav.p_e, config_.acceleration_noise_horizontal,
                                config_.acceleration_noise_vertical, dt, covariance);
  if (process_.continuous)
    process_.transition.middleRows<3>(kPosition) +=
        dt * process_.transition.middleRows<3>(kVelocity);
  state_.nav.p_e += dt * state_.nav.v_e;
  state_.nav.time = time;
  if (!has_attitude_) return;
  for (EkfCovariance* covariance : covariance_and_noise())
    covariance->diagonal().segment<3>(kAttitude).array() += square(config_.gap_attitude_noise) * dt;
  mechanization_.reset(state_.nav);
}

AntennaMotion Ekf::antenna() const {
  AntennaMotion motion = antenna_motion(state_.nav, measured_rate_b_, lever_arm_b_, has_attitude_,
                                        state_.vehicle, acceleration_e_);
  motion.p_e += vertical_antenna_offset_e();
  return motion;
}

Vector3d Ekf::vertical_antenna_offset_e() const {
  if (has_attitude_ || !config_.vertical_arm) return Vector3d::Zero();
  return vertical_arm_e(state_.nav.p_e);
}

Vector3d Ekf::vertical_arm_e(const Vector3d& p_e) const {
  return rotation_ecef_to_ned(to_geodetic(p_e)).transpose() * Vector3d(0.0, 0.0, lever_arm_b_.z());
}

Vector3d Ekf::antenna_position_e() const { return antenna().p_e; }

Vector3d Ekf::antenna_velocity_e() const { return antenna().v_e; }

bool Ekf::is_finite() const { return leonav::is_finite(state_) && covariance_.allFinite(); }

boost::container::static_vector<EkfCovariance*, 2> Ekf::covariance_and_noise() {
  boost::container::static_vector<EkfCovariance*, 2> both{&covariance_};
  if (process_.continuous) both.push_back(&process_.noise);
  return both;
}

}  // namespace leonav
