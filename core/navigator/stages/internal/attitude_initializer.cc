#include "core/navigator/stages/internal/attitude_initializer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/square.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/navigator/interface/filter_estimate.h"
#include "core/navigator/interface/solution_conversion.h"

namespace leonav {
namespace {

bool block_ends_at_epoch(const EpochWork& work) {
  return !work.block.empty() && work.block.back().time == work.time;
}

}  // namespace

double heading_change(const NavState& state, const ImuBlock& samples, GpsTime until) {
  const Eigen::Quaterniond q_ne(rotation_ecef_to_ned(to_geodetic(state.p_e)));
  const Eigen::Quaterniond first = q_ne * state.q_eb;
  Eigen::Quaterniond q_nb = first;
  for (const ImuSample& sample : samples) {
    if (sample.start() < state.time) continue;
    if (sample.start() >= until) break;
    const ImuSample part = sample.time > until ? split(sample, until).before : sample;
    q_nb = q_nb * quaternion_from_rotation_vector(correct(part, state.errors).delta_theta_b);
  }
  return wrap_to_pi(euler_from_rotation(q_nb.toRotationMatrix()).yaw -
                    euler_from_rotation(first.toRotationMatrix()).yaw);
}

AttitudeInitializer::AttitudeInitializer(const NavigatorConfig& config)
    : config_(config.alignment),
      inertial_(config.motion == MotionModel::kInertial),
      alignment_(config.alignment, config.imu),
      heading_monitor_(config.alignment, config.imu),
      checkpoint_monitor_(config.alignment, config.imu.gyro_bias.sigma,
                          config.checkpoint_max_age_s) {
  if (config_.initial_heading)
    external_heading_.set({*config_.initial_heading, config_.initial_heading_sigma});
}

void AttitudeInitializer::add(const ImuBlock& block, const Ekf& filter) {
  if (!inertial_ || filter.has_attitude()) return;
  for (const ImuSample& sample : block) {
    alignment_.add(sample);
    checkpoint_monitor_.add(sample);
  }
}

bool AttitudeInitializer::is_due(const EpochWork& work, const Ekf& filter) const {
  return inertial_ && !filter.has_attitude() && block_ends_at_epoch(work);
}

// Waits until the levelling is done, so that the attitude follows at once: a heading from a
// checkpoint must not wait unmonitored. A heading from configuration or command has priority.
std::optional<AttitudeInitializer::CheckpointVerdict> AttitudeInitializer::evaluate_checkpoint(
    GpsTime time, const Ekf& filter) {
  if (!checkpoint_monitor_.pending() || !alignment_.levelled()) return std::nullopt;
  if (external_heading_.get()) return checkpoint_monitor_.not_needed();
  const auto verdict =
      checkpoint_monitor_.evaluate({time, filter.antenna_position_e(), position_sigma(filter),
                                    filter.antenna_velocity_e().norm(), velocity_sigma(filter)});
  if (verdict && verdict->use == CheckpointUse::kUsed) external_heading_.set(verdict->heading);
  return verdict;
}

std::optional<AttitudeInitializer::FirstAttitude> AttitudeInitializer::first_attitude(
    const Ekf& filter) {
  const auto given = external_heading_.get();
  const auto aligned = alignment_.attitude(filter.antenna_position_e(), filter.antenna_velocity_e(),
                                           velocity_sigma(filter), given);
  if (!aligned) return std::nullopt;
  external_heading_.use();
  return FirstAttitude{*aligned, given.has_value()};
}

void AttitudeInitializer::start_heading_monitor(const Ekf& filter) {
  if (!config_.heading_watch) return;
  heading_monitor_.start(filter.state().errors.gyro_bias_b, gyro_bias_sigma(filter));
}

std::optional<AttitudeInitializer::CheckpointVerdict> AttitudeInitializer::discard_checkpoint() {
  if (!checkpoint_monitor_.pending()) return std::nullopt;
  return checkpoint_monitor_.not_needed();
}

bool AttitudeInitializer::contradicts_motion(double heading, double sigma,
                                             const Ekf& filter) const {
  constexpr double kSlow = 3.0;  // m/s
  constexpr double kSigmas = 3.0, kMost = std::numbers::pi / 4.0;
  // On wheels: the mounting and the axle's slip, and what a turn adds. An antenna at a distance L
  // of 3 m from the axle moves across by L times the rate, at a lateral acceleration a of 5 m/s^2
  // by L a / v^2 of its speed v. Wind and current push boats and aircraft sideways at any speed.
  constexpr double kAlong = std::numbers::pi / 12.0, kSwing_m2_s2 = 3.0 * 5.0;
  // A heading can be watched only where the vehicle drives along its axis.
  if (!inertial_ || !config_.heading_watch || !filter.initialized()) return false;
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(filter.antenna_position_e()));
  const Eigen::Vector2d velocity = (C_ne * filter.antenna_velocity_e()).head<2>();
  const double speed = velocity.norm(), speed_sigma = velocity_sigma(filter);
  if (!(speed > kSlow && speed > 10.0 * speed_sigma)) return false;
  const double off = wrap_to_pi(heading - std::atan2(velocity.y(), velocity.x()));
  const double from_axis = std::min(std::abs(off), std::numbers::pi - std::abs(off));
  const bool on_wheels = config_.max_reverse_speed_m_s > 0.0;
  const double allowed = on_wheels ? std::min(kMost, kAlong + kSwing_m2_s2 / square(speed)) : kMost;
  return from_axis > allowed + kSigmas * std::hypot(sigma, speed_sigma / speed);
}

std::optional<AttitudeInitializer::TurnedAttitude> AttitudeInitializer::set_heading(
    double heading, double sigma, const Ekf& filter) {
  if (!inertial_) return std::nullopt;
  external_heading_.set({heading, sigma});
  if (!filter.has_attitude()) return std::nullopt;
  external_heading_.use();
  const NavState& state = filter.state();
  Eigen::Vector3d sigma_rpy = sigma_of_euler(filter);
  sigma_rpy.z() = sigma;
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(state.p_e));
  EulerAngles euler = euler_from_rotation(C_ne * state.q_eb.toRotationMatrix());
  euler.yaw = wrap_to_pi(heading);
  const Eigen::Matrix3d C_eb = C_ne.transpose() * rotation_from_euler(euler);
  return TurnedAttitude{Eigen::Quaterniond(C_eb).normalized(), sigma_rpy};
}

bool AttitudeInitializer::monitor_heading(const EpochWork& work, const Ekf& filter, bool updated) {
  if (!heading_monitor_.started()) return false;
  if (!filter.has_attitude()) {
    heading_monitor_.stop();
    return false;
  }
  heading_monitor_.add({work.block.data(), work.block.size()});
  return !work.empty && block_ends_at_epoch(work) && updated;
}

std::optional<double> AttitudeInitializer::heading_error(const IndependentSolution& solution,
                                                         const Ekf& filter) {
  const PointSolution& point = solution.point;
  if (!solution.accepted || !point.has_velocity || !is_highly_redundant(solution))
    return std::nullopt;
  const NavState& state = filter.state();
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(state.p_e));
  const HeadingMonitor::Filter estimate = {
      Eigen::Quaterniond(Eigen::Matrix3d(C_ne * state.q_eb.toRotationMatrix())),
      sigma_of_euler(filter).z(), state.errors.gyro_bias_b, gyro_bias_sigma(filter)};
  const double sigma_v = norm_of_sigmas(point.covariance_v_e) / std::sqrt(3.0);
  return heading_monitor_.add_velocity((C_ne * point.v_e).head<2>(), sigma_v, estimate);
}

void AttitudeInitializer::monitor_motion(const EpochWork& work, const Ekf& filter) {
  for (const ImuSample& sample : work.block)
    external_heading_.end_on_motion(sample, config_.static_gyro_rad_s);
  if (!filter.initialized()) return;
  external_heading_.end_on_motion(filter.antenna_velocity_e().norm(), velocity_sigma(filter),
                                  config_.min_course_speed_m_s);
}

AlignmentNeed AttitudeInitializer::need(const Ekf& filter, double latitude) const {
  if (!inertial_ || filter.has_attitude()) return {};
  if (!filter.initialized()) return {Lacking::kPosition};
  return alignment_.need(latitude);
}

void AttitudeInitializer::forget_heading() {
  heading_monitor_.stop();
  external_heading_.forget();
}

}  // namespace leonav
