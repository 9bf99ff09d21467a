#include "core/filter/estimate/inertial_propagator.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/earth/gravity.h"
#include "core/inertial/strapdown/imu_gap_fill.h"

namespace leonav {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSubBlock = 0.0245;        // s; the covariance moves once per so much IMU data
constexpr double kAccelerationTime = 0.05;  // s, of the acceleration's fading mean

}  // namespace

void InertialPropagator::reset() {
  last_sample_ = ImuSample();
  body_ = BodyMotion();
}

void InertialPropagator::restart(const NavState& nav, const ImuSample& last_sample) {
  last_sample_ = last_sample;
  if (last_sample.interval_ns > 0)
    body_.measured_rate_b = last_sample.delta_theta_b / last_sample.interval_s();
  mechanization_.reset(nav, last_sample);
}

void InertialPropagator::remember(std::span<const ImuSample> block) {
  if (block.empty() || block.back().interval_ns <= 0) return;
  last_sample_ = block.back();
  body_.measured_rate_b = last_sample_.delta_theta_b / last_sample_.interval_s();
}

bool InertialPropagator::predict(std::span<const ImuSample> block, GpsTime time,
                                 StateEstimate* estimate, SpeedHistory* speeds) {
  bool uninterrupted = true;
  const bool inertial = estimate->has_attitude();
  const NavState& nav = estimate->state().nav;
  const GpsTime start = nav.time;
  if (inertial) {
    mechanization_.continue_from(nav);
    begin_sub_block(*estimate);
  }
  for (const ImuSample& sample : block) {
    if (sample.interval_ns <= 0 || sample.time > time) continue;
    if (sample.time <= nav.time) continue;  // already behind the estimate
    if (inertial)
      uninterrupted &= advance_to_sample(sample, estimate);
    else
      body_.measured_rate_b = sample.delta_theta_b / sample.interval_s();
    last_sample_ = sample;
    if (speeds != nullptr && inertial) speeds->add(estimate->state(), body_.measured_rate_b);
  }
  if (time > nav.time) uninterrupted &= fill_gap(time, ImuSample{}, estimate);
  if (inertial) finish_sub_block(estimate);

  const double dt = seconds_between(nav.time, start);
  if (dt > 0.0) estimate->propagate_slow_states(imu_, dt);
  return uninterrupted;
}

bool InertialPropagator::advance_to_sample(const ImuSample& sample, StateEstimate* estimate) {
  const NavState& nav = estimate->state().nav;
  bool uninterrupted = true;
  if (sample.start() > nav.time) uninterrupted = fill_gap(sample.start(), sample, estimate);
  advance(sample.start() < nav.time ? split(sample, nav.time).after : sample, estimate);
  return uninterrupted;
}

void InertialPropagator::advance(const ImuSample& sample, StateEstimate* estimate) {
  const NavState& nav = estimate->state().nav;
  const Matrix3d C_before = nav.q_eb.toRotationMatrix();
  const Vector3d v_before_e = nav.v_e;
  mechanization_.advance(sample);
  estimate->set_inertial_state(mechanization_.state());
  if (averages_acceleration_) average_acceleration(nav.v_e - v_before_e, sample.interval_s());
  body_.measured_rate_b = sample.delta_theta_b / sample.interval_s();
  transition_.add({.C_eb = 0.5 * (C_before + nav.q_eb.toRotationMatrix()),
                   .f_b = mechanization_.specific_force_b(),
                   .omega_ib_b = mechanization_.omega_ib_b(),
                   .interval_s = sample.interval_s()});
  if (transition_.duration_s() >= kSubBlock) finish_sub_block(estimate);
}

// A mean, because an engine's vibration is not how the vehicle moves.
void InertialPropagator::average_acceleration(const Vector3d& change_e, double interval_s) {
  const double share = std::min(1.0, interval_s / kAccelerationTime);
  body_.acceleration_e += share * (change_e / interval_s - body_.acceleration_e);
}

void InertialPropagator::begin_sub_block(const StateEstimate& estimate) {
  const FilterState& state = estimate.state();
  ImuErrorModel imu = imu_;
  if (state.random_walk.noise > 0.0 && state.nav.time < state.random_walk.until)
    imu.angle_random_walk = std::hypot(imu.angle_random_walk, state.random_walk.noise);
  transition_.begin(imu, state.nav.errors, gravity_gradient_e(state.nav.p_e));
}

void InertialPropagator::finish_sub_block(StateEstimate* estimate) {
  estimate->propagate(transition_);
  begin_sub_block(*estimate);
}

// A short gap is a sample that was not measured and adds its own uncertainty.
bool InertialPropagator::fill_gap(GpsTime time, const ImuSample& next, StateEstimate* estimate) {
  const auto gap_fill = estimate->has_attitude()
                            ? fill_imu_gap(last_sample_, estimate->state().nav.time, time, next)
                            : std::nullopt;
  if (!gap_fill) return coast(time, estimate);
  advance(gap_fill->sample, estimate);
  finish_sub_block(estimate);
  estimate->add_gap_noise(*gap_fill);
  return false;
}

bool InertialPropagator::coast(GpsTime time, StateEstimate* estimate) {
  if (estimate->has_attitude()) finish_sub_block(estimate);
  body_.acceleration_e.setZero();
  estimate->coast(time);
  if (estimate->has_attitude() && !is_static_) mechanization_.reset(estimate->state().nav);
  return !estimate->has_attitude();
}

}  // namespace leonav
