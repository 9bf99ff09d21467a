#include "core/navigator/stages/internal/anchor_propagation.h"

#include "core/earth/gravity.h"
#include "core/inertial/strapdown/imu_gap_fill.h"
#include "core/navigator/stages/internal/covariance_propagation.h"

namespace leonav {
namespace {

// White acceleration, (m/s^2)/sqrt(Hz), and rotation, rad/sqrt(s), of a vehicle without IMU
// samples.
constexpr double kGapAcceleration = 3.0;
constexpr double kGapRotation = 0.5;

}  // namespace

AnchorPropagation::AnchorPropagation(const NavigatorConfig& config)
    : imu_errors_(config.imu),
      acceleration_noise_(config.ekf.acceleration_noise_horizontal),
      samples_(kMaxImuHistory) {}

void AnchorPropagation::add_sample(const ImuSample& sample) {
  samples_.push_back(sample);
  if (anchor_.valid) step(sample);
}

bool AnchorPropagation::has_discarded_after(GpsTime time) const {
  const bool too_old = samples_.empty() || samples_.front().start() > time;
  return too_old && samples_.full();
}

void AnchorPropagation::restart_from(const Anchor& anchor, GpsTime needed_from) {
  anchor_ = anchor;
  unfilled_s_ = gap_angle_variance_ = gap_velocity_variance_ = 0.0;
  remove_samples_before(needed_from);
  mechanization_.reset(anchor.state);
  for (const ImuSample& sample : samples_) step(sample);
}

void AnchorPropagation::clear_anchor() {
  anchor_ = Anchor();
  unfilled_s_ = 0.0;
  gap_angle_variance_ = gap_velocity_variance_ = 0.0;
}

void AnchorPropagation::clear_samples() {
  samples_.clear();
  last_sample_ = ImuSample();
}

void AnchorPropagation::remove_samples_before(GpsTime time) {
  while (!samples_.empty() && samples_.front().time <= time) {
    last_sample_ = samples_.front();
    samples_.pop_front();
  }
  if (!samples_.empty() && samples_.front().start() < time) {
    const ImuSplit parts = split(samples_.front(), time);
    last_sample_ = parts.before;
    samples_.front() = parts.after;
  }
}

void AnchorPropagation::step(const ImuSample& sample) {
  if (!anchor_.has_attitude) return;
  if (sample.time <= mechanization_.state().time) {
    last_sample_ = sample;
    return;
  }
  const GpsTime from = mechanization_.state().time;
  if (sample.start() > from) fill_gap(sample);
  mechanization_.advance(sample.start() < from ? split(sample, from).after : sample);
  last_sample_ = sample;
}

// Moves the mechanization over a gap in the stream, to the start of `next`.
void AnchorPropagation::fill_gap(const ImuSample& next) {
  const GpsTime from = mechanization_.state().time;
  const double gap_s = seconds_between(next.start(), from);
  if (const auto gap_fill = fill_imu_gap(last_sample_, from, next.start(), next)) {
    mechanization_.advance(gap_fill->sample);
    gap_angle_variance_ += gap_fill->sigma_theta_b.cwiseAbs2().maxCoeff();
    gap_velocity_variance_ += gap_fill->sigma_velocity_b.cwiseAbs2().maxCoeff();
    return;
  }
  NavState state = mechanization_.state();
  state.p_e += gap_s * state.v_e;
  state.time = next.start();
  mechanization_.reset(state);
  unfilled_s_ += gap_s;
}

NavState AnchorPropagation::state(GpsTime now) const {
  if (anchor_.has_attitude) return at_stamp(mechanization_.state(), anchor_.time_offset_s);
  NavState state = anchor_.state;
  state.p_e += seconds_between(now, anchor_.state.time) * state.v_e;
  state.time = now;
  return state;
}

PvaCovariance AnchorPropagation::covariance(GpsTime now) const {
  const double elapsed_s = seconds_between(now, anchor_.state.time);
  if (!anchor_.has_attitude) {
    return constant_velocity_covariance(anchor_, acceleration_noise_, elapsed_s);
  }
  const NavState& state = mechanization_.state();
  // The mean specific force since the anchor is the mean acceleration minus gravity.
  Eigen::Vector3d f_e = -gravity_e(state.p_e);
  if (elapsed_s > 0.0) f_e += (state.v_e - anchor_.state.v_e) / elapsed_s;
  PvaCovariance covariance =
      inertial_covariance(anchor_, imu_errors_, f_e, state.q_eb.toRotationMatrix(), elapsed_s);
  covariance.diagonal().head<3>().array() += gap_velocity_variance_ * elapsed_s * elapsed_s;
  covariance.diagonal().segment<3>(3).array() += gap_velocity_variance_;
  covariance.diagonal().tail<3>().array() += gap_angle_variance_;
  if (unfilled_s_ > 0.0) {
    add_acceleration_noise(kGapAcceleration, unfilled_s_, &covariance);
    covariance.diagonal().tail<3>().array() += kGapRotation * kGapRotation * unfilled_s_;
  }
  return covariance;
}

}  // namespace leonav
