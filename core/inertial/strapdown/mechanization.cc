#include "core/inertial/strapdown/mechanization.h"

#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/earth/gravity.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

const Eigen::Vector3d kOmegaIe(0.0, 0.0, kEarthRotationRate);

// Weight of the cross products of the previous and this sample's increments, for rate and specific
// force linear in time across both: T^2 / (6 T_p (T_p + T)), which is 1/12 for equal intervals
// (Savage, J. Guidance 21, 1998, part 1 eq. 58 and part 2; here for unequal ones).
double two_sample_weight(const ImuSample& previous, const ImuSample& sample) {
  if (previous.interval_ns <= 0) return 0.0;
  const double t_previous = previous.interval_s(), t = sample.interval_s();
  // An interval much shorter than this sample would amplify its noise more than it corrects.
  if (t > 4.0 * t_previous) return 0.0;
  return t * t / (6.0 * t_previous * (t_previous + t));
}

// Velocity increment in the body frame at the start of the interval, in closed form for constant
// rate and specific force (Savage, part 2, eqs. 36-37), plus sculling.
Eigen::Vector3d velocity_increment(const Eigen::Vector3d& alpha, const Eigen::Vector3d& upsilon,
                                   const Eigen::Vector3d& sculling) {
  const double angle2 = alpha.squaredNorm();
  double first = 0.5 - angle2 / 24.0;        // (1 - cos x) / x^2
  double second = 1.0 / 6.0 - angle2 / 120;  // (1 - sin x / x) / x^2
  if (angle2 > 1e-6) {
    const double angle = std::sqrt(angle2);
    first = (1.0 - std::cos(angle)) / angle2;
    second = (1.0 - std::sin(angle) / angle) / angle2;
  }
  const Eigen::Vector3d cross = alpha.cross(upsilon);
  return upsilon + first * cross + second * alpha.cross(cross) + sculling;
}

}  // namespace

ImuSample correct(const ImuSample& sample, const ImuErrors& errors) {
  ImuSample corrected = sample;
  const double dt = sample.interval_s();
  corrected.delta_theta_b = (sample.delta_theta_b - errors.gyro_bias_b * dt)
                                .cwiseQuotient(Eigen::Vector3d::Ones() + errors.gyro_scale);
  corrected.delta_velocity_b = (sample.delta_velocity_b - errors.accel_bias_b * dt)
                                   .cwiseQuotient(Eigen::Vector3d::Ones() + errors.accel_scale);
  return corrected;
}

void Mechanization::reset(const NavState& state) {
  state_ = state;
  specific_force_b_.setZero();
  omega_ib_b_.setZero();
  previous_ = ImuSample();
}

void Mechanization::reset(const NavState& state, const ImuSample& previous) {
  reset(state);
  if (previous.interval_ns > 0 && previous.time == state.time)
    previous_ = correct(previous, state.errors);
}

void Mechanization::continue_from(const NavState& state) {
  if (state.time != state_.time) return reset(state);
  state_ = state;
}

void Mechanization::advance(const ImuSample& raw) {
  const ImuSample sample = correct(raw, state_.errors);
  const double dt = sample.interval_s();
  const Eigen::Vector3d& alpha = sample.delta_theta_b;
  const Eigen::Vector3d& upsilon = sample.delta_velocity_b;
  const double weight = two_sample_weight(previous_, sample);
  const Eigen::Vector3d coning = weight * previous_.delta_theta_b.cross(alpha);
  const Eigen::Vector3d sculling =
      weight * (previous_.delta_theta_b.cross(upsilon) + previous_.delta_velocity_b.cross(alpha));

  // The specific force is turned into e. The body frame at the start is fixed in i, so it turns
  // back against e by the Earth's rotation, by half of the angle on average.
  const Eigen::Vector3d force_b = velocity_increment(alpha, upsilon, sculling);
  Eigen::Vector3d force_e = state_.q_eb * force_b;
  force_e -= 0.5 * dt * kOmegaIe.cross(force_e);

  // Gravity and Coriolis acceleration are taken at the middle of the interval.
  const Eigen::Vector3d v_start = state_.v_e;
  const Eigen::Vector3d a_start =
      force_e / dt + gravity_e(state_.p_e) - 2.0 * kOmegaIe.cross(v_start);
  const Eigen::Vector3d v_middle = v_start + 0.5 * dt * a_start;
  const Eigen::Vector3d p_middle = state_.p_e + 0.5 * dt * v_start + 0.125 * dt * dt * a_start;
  const Eigen::Vector3d field = gravity_e(p_middle) - 2.0 * kOmegaIe.cross(v_middle);

  state_.v_e = v_start + force_e + dt * field;
  state_.p_e += 0.5 * dt * (v_start + state_.v_e);
  const Eigen::Quaterniond earth = quaternion_from_rotation_vector(-dt * kOmegaIe);
  const Eigen::Quaterniond body = quaternion_from_rotation_vector(alpha + coning);
  state_.q_eb = (earth * state_.q_eb * body).normalized();
  state_.time = sample.time;

  specific_force_b_ = upsilon / dt;
  omega_ib_b_ = alpha / dt;
  previous_ = sample;
}

}  // namespace leonav
