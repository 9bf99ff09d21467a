#include "core/filter/estimate/state_estimate.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/filter/innovation_tests/clock_steps.h"
#include "core/filter/process/constant_velocity.h"
#include "core/filter/state/ambiguities.h"
#include "core/filter/state/clock_model.h"
#include "core/filter/update/covariance_inflation.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kUnknownVelocity = 50.0;  // m/s, 1 sigma where the point solution has none
// A point solution states no sigma of its clocks. They start with this 1 sigma, m and m/s, and so
// many times that of its position or velocity (3D) beside.
constexpr double kStartClockSigma = 10.0, kStartDriftSigma = 1.0, kStartClockShare = 3.0;

// Correlation time of what the model of the ionosphere leaves at the zenith, a Gauss-Markov
// process.
constexpr double kIonosphereTime_s = 3600.0;

double gauss_markov_decay(const GaussMarkov& process, double dt) {
  return std::exp(-dt / process.correlation_time_s);
}

// Turns errors of roll, pitch and yaw into a rotation of the body in n, to first order.
Matrix3d rotation_from_rpy_errors(const Matrix3d& C_nb) {
  const EulerAngles angles = euler_from_rotation(C_nb);
  const Matrix3d yaw = rotation_from_euler({0.0, 0.0, angles.yaw});
  Matrix3d J;
  J << C_nb.col(0), yaw.col(1), Vector3d::UnitZ();
  return J;
}

// Jacobian from the IMU's error state to the antenna's (direction 1) or back (-1): attitude and
// gyro errors move the arm.
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

// Turns a correction of the antenna's position and velocity into one of the state's own.
EkfCorrection of_state(const EkfCorrection& of_antenna, const AntennaMotion& antenna) {
  EkfCorrection correction = of_antenna;
  if (!antenna.estimated) return correction;
  const AntennaVector constants = of_antenna.segment<kAntennaConstants>(kSize + kLeverArm);
  correction.segment<3>(kPosition) -= antenna.d_p_d_constants * constants;
  correction.segment<3>(kVelocity) -= antenna.d_v_d_constants * constants;
  return correction;
}

double start_variance(const VehicleConstantsConfig& config, int constant) {
  return square(config.sigma[static_cast<std::size_t>(constant)]);
}

}  // namespace

StateEstimate::StateEstimate(const EkfConfig& config) : config_(config) {}

bool StateEstimate::is_finite() const {
  return leonav::is_finite(state_) && covariance_.allFinite();
}

void StateEstimate::begin_process() {
  if (config_.keep_process) process_.begin(covariance_.rows());
}

void StateEstimate::initialize(GpsTime time, const PointSolution& point,
                               const Vector3d& antenna_offset_e) {
  const VehicleConstants vehicle = state_.vehicle;
  state_ = FilterState{};
  state_.vehicle = vehicle;
  state_.nav.time = time;
  state_.nav.p_e = point.p_e;
  state_.nav.p_e -= antenna_offset_e;
  const bool moves = !config_.static_point;
  state_.nav.v_e = moves && point.has_velocity ? point.v_e : Vector3d::Zero();
  known_clocks_ = ClockFlags{};
  start_vehicle_constants();
  covariance_(kWetDelay, kWetDelay) = square(config_.wet_delay_sigma_m);
  ionosphere_variance_ = 0.0;
  covariance_.block<3, 3>(kPosition, kPosition) = point.covariance_p_e;
  if (moves) {
    covariance_.block<3, 3>(kVelocity, kVelocity) =
        point.has_velocity ? point.covariance_v_e
                           : Matrix3d(square(kUnknownVelocity) * Matrix3d::Identity());
  }
  const double clock_sigma =
      kStartClockSigma + kStartClockShare * std::sqrt(point.covariance_p_e.trace());
  const double drift_sigma =
      kStartDriftSigma + kStartClockShare * std::sqrt(point.covariance_v_e.trace());
  for (std::size_t system = 0; system < kMaxSystemTimes; ++system) {
    if (!std::isfinite(point.clock_m[system])) continue;
    leonav::start_clock_offset(system, point.clock_m[system], clock_sigma, &state_.clocks,
                               &covariance_);
    known_clocks_.offset[system] = true;
    const bool has_drift = point.has_velocity && std::isfinite(point.clock_drift_m_s[system]);
    leonav::start_clock_drift(system, has_drift ? point.clock_drift_m_s[system] : 0.0,
                              has_drift ? drift_sigma : kUnknownDriftSigma, &state_.clocks,
                              &covariance_);
    known_clocks_.drift[system] = true;
  }
  process_.continuous = false;
  has_attitude_ = false;
}

void StateEstimate::set_exactly(const CoreState& state, bool has_attitude) {
  static_cast<CoreState&>(state_) = state;
  state_.ambiguities.clear();
  has_attitude_ = has_attitude;
  covariance_.setZero(state.size(), state.size());
  begin_process();
}

void StateEstimate::set_attitude(const Eigen::Quaterniond& q_eb, const Vector3d& sigma_rpy,
                                 const ImuErrors& errors, const ImuErrorCovariance& covariance,
                                 const AntennaModel& model, const BodyMotion& body) {
  const AntennaMotion before = model.motion(state_, has_attitude_, body);
  EkfCovariance P = covariance_;
  if (has_attitude_) {
    const EkfCovariance T = to_antenna(before, 1.0, covariance_.rows());
    P = T * covariance_ * T.transpose();
  }
  P.middleRows<kInsSize - kAttitude>(kAttitude).setZero();
  P.middleCols<kInsSize - kAttitude>(kAttitude).setZero();
  P.block<12, 12>(kGyroBias, kGyroBias) = covariance;
  state_.nav.errors = errors;
  apply_attitude(before, q_eb, sigma_rpy, P, model, body);
}

void StateEstimate::replace_attitude(const Eigen::Quaterniond& q_eb, const Vector3d& sigma_rpy,
                                     const AntennaModel& model, const BodyMotion& body) {
  const AntennaMotion before = model.motion(state_, has_attitude_, body);
  const EkfCovariance T = to_antenna(before, 1.0, covariance_.rows());
  EkfCovariance P = T * covariance_ * T.transpose();
  P.middleRows<3>(kAttitude).setZero();
  P.middleCols<3>(kAttitude).setZero();
  apply_attitude(before, q_eb, sigma_rpy, P, model, body);
  process_.replaced = true;
}

void StateEstimate::forget_attitude(const AntennaModel& model, const BodyMotion& body) {
  const AntennaMotion antenna = model.motion(state_, true, body);
  const EkfCovariance T = to_antenna(antenna, 1.0, covariance_.rows());
  const EkfCovariance P = covariance_;
  covariance_.noalias() = T * P * T.transpose();
  covariance_.middleRows<kInsSize - kAttitude>(kAttitude).setZero();
  covariance_.middleCols<kInsSize - kAttitude>(kAttitude).setZero();
  const GpsTime time = state_.nav.time;
  state_.nav = NavState();
  state_.nav.time = time;
  state_.nav.p_e = antenna.p_e - model.offset_without_attitude_e(antenna.p_e);
  state_.nav.v_e = antenna.v_e;
  state_.random_walk = AttitudeRandomWalk();
  has_attitude_ = false;
  process_.continuous = false;
}

void StateEstimate::replace_motion(const NavState& nav, const InertialCovariance& covariance,
                                   const AttitudeRandomWalk& random_walk) {
  while (!state_.ambiguities.empty())
    remove_ambiguity(static_cast<int>(state_.ambiguities.size()) - 1);
  state_.nav = nav;
  state_.random_walk = random_walk;
  covariance_.topRows<kInsSize>().setZero();
  covariance_.leftCols<kInsSize>().setZero();
  covariance_.topLeftCorner<kInsSize, kInsSize>() = covariance;
  has_attitude_ = true;
  process_.continuous = false;
}

// `of_antenna` is the covariance with position and velocity of the antenna, its attitude empty.
void StateEstimate::apply_attitude(const AntennaMotion& before, const Eigen::Quaterniond& q_eb,
                                   const Vector3d& sigma_rpy, const EkfCovariance& of_antenna,
                                   const AntennaModel& model, const BodyMotion& body) {
  state_.nav.q_eb = q_eb.normalized();
  state_.nav.p_e.setZero();
  state_.nav.v_e.setZero();
  AntennaMotion arm = model.motion(state_, true, body);
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
}

void StateEstimate::raise_attitude_noise(double noise, double seconds) {
  state_.random_walk = {noise, state_.nav.time.plus_seconds(seconds)};
}

void StateEstimate::propagate(const InsTransition& transition) {
  for (EkfCovariance* covariance : covariance_and_noise()) transition.propagate(covariance);
  if (process_.continuous) transition.advance(&process_.transition);
}

void StateEstimate::add_gap_noise(const ImuGapFill& gap_fill) {
  const Matrix3d C_eb = state_.nav.q_eb.toRotationMatrix();
  const double half = 0.5 * gap_fill.sample.interval_s();
  const Matrix3d V = C_eb * gap_fill.sigma_velocity_b.cwiseAbs2().asDiagonal() * C_eb.transpose();
  for (EkfCovariance* covariance : covariance_and_noise()) {
    covariance->block<3, 3>(kPosition, kPosition) += half * half * V;
    covariance->block<3, 3>(kPosition, kVelocity) += half * V;
    covariance->block<3, 3>(kVelocity, kPosition) += half * V;
    covariance->block<3, 3>(kVelocity, kVelocity) += V;
    covariance->block<3, 3>(kAttitude, kAttitude) +=
        C_eb * gap_fill.sigma_theta_b.cwiseAbs2().asDiagonal() * C_eb.transpose();
  }
}

void StateEstimate::coast(GpsTime time) {
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
  // Biases and scales keep their variances, which are stationary.
  for (EkfCovariance* covariance : covariance_and_noise())
    covariance->diagonal().segment<3>(kAttitude).array() += square(config_.gap_attitude_noise) * dt;
}

void StateEstimate::propagate_slow_states(const ImuErrorModel& imu, double dt) {
  state_.nav.errors.gyro_bias_b *= gauss_markov_decay(imu.gyro_bias, dt);
  state_.nav.errors.accel_bias_b *= gauss_markov_decay(imu.accel_bias, dt);
  state_.nav.errors.gyro_scale *= gauss_markov_decay(imu.gyro_scale, dt);
  state_.nav.errors.accel_scale *= gauss_markov_decay(imu.accel_scale, dt);
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
  propagate_ionosphere(dt);
}

void StateEstimate::propagate_ionosphere(double dt) {
  if (!(ionosphere_variance_ > 0.0)) return;
  const double decay = std::exp(-dt / kIonosphereTime_s);
  state_.ionosphere_m *= decay;
  for (EkfCovariance* covariance : covariance_and_noise()) {
    covariance->row(kIonosphere) *= decay;
    covariance->col(kIonosphere) *= decay;
    (*covariance)(kIonosphere, kIonosphere) += (1.0 - decay * decay) * ionosphere_variance_;
  }
  if (process_.continuous) process_.transition.row(kIonosphere) *= decay;
}

void StateEstimate::set_ionosphere_sigma(double sigma_m) {
  const bool starts = !(ionosphere_variance_ > 0.0);
  ionosphere_variance_ = square(sigma_m);
  if (!starts) return;
  covariance_(kIonosphere, kIonosphere) = ionosphere_variance_;
  if (process_.continuous) process_.start(kIonosphere, ionosphere_variance_);
}

void StateEstimate::step_ionosphere_model(double step_m) {
  if (!(ionosphere_variance_ > 0.0)) return;
  state_.ionosphere_m -= step_m;
  for (EkfCovariance* covariance : covariance_and_noise())
    (*covariance)(kIonosphere, kIonosphere) += square(step_m);
}

void StateEstimate::to_antenna_parametrization(const AntennaMotion& antenna) {
  apply_antenna_transform(antenna, 1.0);
}

// Any variance that the update adds to position or velocity is the same in both parametrizations.
void StateEstimate::apply_antenna_transform(const AntennaMotion& antenna, double direction) {
  if (!antenna.estimated) return;
  Eigen::Matrix<double, 6, kAntennaConstants> slopes;
  slopes << antenna.d_p_d_constants, antenna.d_v_d_constants;
  slopes *= direction;
  constexpr int kFirst = kSize + kLeverArm;
  EkfCovariance& P = covariance_;
  P.middleRows<6>(kPosition).noalias() +=
      slopes.lazyProduct(P.middleRows<kAntennaConstants>(kFirst));
  P.middleCols<6>(kPosition).noalias() +=
      P.middleCols<kAntennaConstants>(kFirst).lazyProduct(slopes.transpose());
}

RobustUpdateResult StateEstimate::correct(const RobustConfig& config, const AntennaMotion& antenna,
                                          FilterMeasurements* measurements,
                                          RobustUpdate* robust_update) {
  const RobustUpdateResult update = (*robust_update)(config, measurements, &covariance_);
  const EkfCorrection correction = of_state(update.correction, antenna);
  apply_antenna_transform(antenna, -1.0);
  if (process_.continuous) process_.transition.rightCols<1>() -= correction;
  add(correction, has_attitude_, &state_);
  return update;
}

MotionComponents StateEstimate::constrain(MotionMeasurements* measurements, double gate) {
  EkfCorrection correction = EkfCorrection::Zero(covariance_.rows());
  const Eigen::Index known = state_.first_ambiguity();
  MotionComponents used = 0;
  for (MotionMeasurement& measurement : *measurements) {
    const auto h = measurement.row.head(known);
    const EkfCorrection spread = covariance_.leftCols(known) * h;
    const double variance = h.dot(spread.head(known)) + measurement.variance;
    const double innovation = measurement.residual - h.dot(correction.head(known));
    measurement.innovation = innovation;
    measurement.innovation_variance = variance;
    measurement.used = std::abs(innovation) < gate * std::sqrt(variance);
    if (!measurement.used) continue;
    used = static_cast<MotionComponents>(used | 1u << measurement.component);
    if (process_.continuous) {
      EkfCorrection row = EkfCorrection::Zero(covariance_.rows());
      row.head(known) = h;
      process_.condition(row, measurement.residual, measurement.variance);
    }
    const EkfCorrection gain = spread / variance;
    correction += innovation * gain;
    joseph_update(gain, spread, variance, &covariance_);
  }
  for (MotionMeasurement& measurement : *measurements)
    measurement.left =
        measurement.residual - measurement.row.head(known).dot(correction.head(known));
  if (used == 0) return 0;
  if (process_.continuous) process_.transition.rightCols<1>() -= correction;
  add(correction, true, &state_);
  return used;
}

void StateEstimate::inflate(Observable observable, double variance, double interval_s) {
  const EkfCorrection before = covariance_.diagonal();
  inflate_covariance(observable, variance, interval_s, &covariance_);
  if (process_.continuous) process_.noise.diagonal() += covariance_.diagonal() - before;
}

void StateEstimate::inflate_position(double sigma_m) {
  for (EkfCovariance* covariance : covariance_and_noise())
    covariance->diagonal().segment<3>(kPosition).array() += square(sigma_m);
}

void StateEstimate::inflate_along(const EkfCorrection& error) {
  for (EkfCovariance* covariance : covariance_and_noise())
    covariance->noalias() += error * error.transpose();
}

void StateEstimate::scale_sigmas(double of_position, double of_velocity) {
  EkfCorrection scales = EkfCorrection::Ones(covariance_.rows());
  scales.segment<3>(kPosition).setConstant(of_position);
  scales.segment<3>(kVelocity).setConstant(of_velocity);
  for (Eigen::Index i = 0; i < covariance_.rows(); ++i) {
    covariance_.row(i) *= scales(i);
    covariance_.col(i) *= scales(i);
  }
}

void StateEstimate::inflate_ambiguity(int state, double sigma_m) {
  for (EkfCovariance* covariance : covariance_and_noise())
    (*covariance)(state, state) += square(sigma_m);
}

void StateEstimate::start_clock_offset(std::size_t system, double offset_m, double sigma_m) {
  leonav::start_clock_offset(system, offset_m, sigma_m, &state_.clocks, &covariance_);
  if (process_.continuous)
    process_.start(kClock + static_cast<Eigen::Index>(system), square(sigma_m));
  known_clocks_.offset[system] = true;
}

void StateEstimate::start_clock_drift(std::size_t system, double drift_m_s, double sigma_m_s) {
  leonav::start_clock_drift(system, drift_m_s, sigma_m_s, &state_.clocks, &covariance_);
  if (process_.continuous)
    process_.start(kClockDrift + static_cast<Eigen::Index>(system), square(sigma_m_s));
  known_clocks_.drift[system] = true;
}

void StateEstimate::copy_clock_drift(std::size_t from, std::size_t to, double sigma_m_s) {
  leonav::copy_clock_drift(from, to, sigma_m_s, &state_.clocks, &covariance_);
  known_clocks_.drift[to] = true;
  if (!process_.continuous) return;
  const auto f = kClockDrift + static_cast<Eigen::Index>(from);
  const auto t = kClockDrift + static_cast<Eigen::Index>(to);
  EkfCovariance& N = process_.noise;
  N.row(t) = N.row(f);
  N.col(t) = N.col(f);
  N(t, t) = N(f, f) + square(sigma_m_s);
  process_.transition.row(t) = process_.transition.row(f);
}

void StateEstimate::shift_clocks(int system, double step_m, double sigma_m) {
  EkfVector direction = EkfVector::Zero();
  for (std::size_t i = 0; i < kMaxSystemTimes; ++i)
    if (known_clocks_.offset[i] && is_of(static_cast<int>(i), system))
      direction(kClock + static_cast<int>(i)) = 1.0;
  state_.clocks.offset_m += step_m * direction.segment<4>(kClock);
  for (EkfCovariance* covariance : covariance_and_noise())
    covariance->topLeftCorner<kSize, kSize>() +=
        square(sigma_m) * direction * direction.transpose();
}

// What the codes show of the step is noisy; clocks and ambiguities share that noise with opposite
// signs.
void StateEstimate::shift_codes_against_carriers(int system, double step_m, double sigma_m) {
  EkfCorrection direction = EkfCorrection::Zero(covariance_.rows());
  for (std::size_t i = 0; i < kMaxSystemTimes; ++i)
    if (known_clocks_.offset[i] && is_of(static_cast<int>(i), system))
      direction(kClock + static_cast<int>(i)) = 1.0;
  for (std::size_t i = 0; i < state_.ambiguities.size(); ++i) {
    if (is_of(static_cast<int>(index_of(state_.ambiguities[i].satellite.system)), system))
      direction(state_.first_ambiguity() + static_cast<int>(i)) = -1.0;
  }
  state_.clocks.offset_m += step_m * direction.segment<4>(kClock);
  for (std::size_t i = 0; i < state_.ambiguities.size(); ++i)
    state_.ambiguities[i].value_m +=
        step_m * direction(state_.first_ambiguity() + static_cast<int>(i));
  if (!(sigma_m > 0.0)) return;
  for (EkfCovariance* covariance : covariance_and_noise())
    *covariance += square(sigma_m) * direction * direction.transpose();
}

const Ambiguity& StateEstimate::ambiguity_of_state(int state) const {
  return state_.ambiguities[static_cast<std::size_t>(state - state_.first_ambiguity())];
}

Ambiguity& StateEstimate::mutable_ambiguity_of_state(int state) {
  return state_.ambiguities[static_cast<std::size_t>(state - state_.first_ambiguity())];
}

void StateEstimate::shift_ambiguity(int state, double shift_m) {
  mutable_ambiguity_of_state(state).value_m += shift_m;
}

void StateEstimate::set_ambiguity_random_walk(int state, double random_walk) {
  mutable_ambiguity_of_state(state).random_walk = random_walk;
}

void StateEstimate::record_carrier(int state, GpsTime time, bool used) {
  Ambiguity& ambiguity = mutable_ambiguity_of_state(state);
  ambiguity.last_used = time;
  ambiguity.rejected = used ? 0 : ambiguity.rejected + 1;
}

void StateEstimate::add_ambiguity(const Ambiguity& ambiguity, double sigma_m) {
  leonav::add_ambiguity(ambiguity, sigma_m, &state_.ambiguities, &covariance_);
  if (process_.continuous) process_.append(square(sigma_m));
}

void StateEstimate::remove_ambiguity(int index) {
  leonav::remove_ambiguity(index, &state_.ambiguities, &covariance_);
  if (process_.continuous) process_.remove(state_.first_ambiguity() + index);
}

void StateEstimate::record_join(int from, int to, double wrong_probability, double wrong_m) {
  const Ambiguity& old = state_.ambiguities[static_cast<std::size_t>(from)];
  Ambiguity& now = state_.ambiguities[static_cast<std::size_t>(to)];
  now.wrong_join_probability =
      std::min(1.0, now.wrong_join_probability + old.wrong_join_probability + wrong_probability);
  now.wrong_join_m = std::max({now.wrong_join_m, old.wrong_join_m, wrong_m});
}

void StateEstimate::join_ambiguities(int from, int to, double difference_m, double sigma_m) {
  EkfCorrection row = EkfCorrection::Zero(covariance_.rows());
  row(state_.first_ambiguity() + from) = -1.0;
  row(state_.first_ambiguity() + to) = 1.0;
  const double residual =
      difference_m - (state_.ambiguities[static_cast<std::size_t>(to)].value_m -
                      state_.ambiguities[static_cast<std::size_t>(from)].value_m);
  const EkfCorrection spread = covariance_ * row;
  const double variance = row.dot(spread) + square(sigma_m);
  if (process_.continuous)
    process_.join(state_.first_ambiguity() + from, state_.first_ambiguity() + to, residual,
                  square(sigma_m));
  const EkfCorrection gain = spread / variance;
  const EkfCorrection correction = residual * gain;
  joseph_update(gain, spread, variance, &covariance_);
  if (process_.continuous) process_.transition.rightCols<1>() -= correction;
  add(correction, has_attitude_, &state_);
}

void StateEstimate::set_vehicle_constants(const VehicleConstants& values,
                                          const VehicleConstants& variances) {
  const auto count = static_cast<int>(values.size());
  state_.vehicle = values;
  state_.ambiguities.clear();
  covariance_.setZero(kSize + count, kSize + count);
  for (int i = 0; i < count; ++i)
    covariance_(kSize + i, kSize + i) = variances[static_cast<std::size_t>(i)];
}

// Values and variances outlive the filter that found them; correlations do not.
void StateEstimate::start_vehicle_constants() {
  const int known = static_cast<int>(state_.vehicle.size());
  VehicleConstants variances;
  for (int i = 0; i < known; ++i) variances.push_back(covariance_(kSize + i, kSize + i));
  const int count = std::max(config_.vehicle.count, known);
  covariance_.setZero(kSize + count, kSize + count);
  for (int i = 0; i < count; ++i) {
    if (i >= known) state_.vehicle.push_back(0.0);
    covariance_(kSize + i, kSize + i) =
        i < known ? variances[static_cast<std::size_t>(i)] : start_variance(config_.vehicle, i);
  }
}

void StateEstimate::add_vehicle_constants(int constant) {
  const int known = static_cast<int>(state_.vehicle.size());
  if (constant < known) return;
  const Eigen::Index before = kSize + known, more = constant + 1 - known;
  const Eigen::Index after = covariance_.rows() - before;
  EkfCovariance P = EkfCovariance::Zero(before + more + after, before + more + after);
  P.topLeftCorner(before, before) = covariance_.topLeftCorner(before, before);
  P.topRightCorner(before, after) = covariance_.topRightCorner(before, after);
  P.bottomLeftCorner(after, before) = covariance_.bottomLeftCorner(after, before);
  P.bottomRightCorner(after, after) = covariance_.bottomRightCorner(after, after);
  for (int i = known; i <= constant; ++i) {
    state_.vehicle.push_back(0.0);
    P(kSize + i, kSize + i) = start_variance(config_.vehicle, i);
  }
  covariance_ = P;
  process_.continuous = false;
}

void StateEstimate::restart_vehicle_constants(const AntennaMotion& antenna) {
  apply_antenna_transform(antenna, 1.0);
  for (int i = 0; i < static_cast<int>(state_.vehicle.size()); ++i) {
    covariance_.row(kSize + i).setZero();
    covariance_.col(kSize + i).setZero();
    covariance_(kSize + i, kSize + i) = start_variance(config_.vehicle, i);
  }
  apply_antenna_transform(antenna, -1.0);
  process_.continuous = false;
  process_.replaced = true;
}

boost::container::static_vector<EkfCovariance*, 2> StateEstimate::covariance_and_noise() {
  boost::container::static_vector<EkfCovariance*, 2> both{&covariance_};
  if (process_.continuous) both.push_back(&process_.noise);
  return both;
}

}  // namespace leonav
