#include "core/vehicle/motion_aiding.h"

#include <algorithm>
#include <cmath>

#include "core/base/duration.h"
#include "core/earth/ellipsoid.h"
#include "core/filter/state/covariance_blocks.h"

namespace leonav {
namespace {

constexpr double kCorrelationTime_s = 10.0;  // of the error of the speed
// m/s, 1 sigma: usual with satellites, whose errors change soon
constexpr double kSatellitesSpeed = 0.3;
constexpr double kFewSatellites = 3.0;  // factor of the sigma
// If the IMU's bias may change by more than this (1 sigma, m/s^2) within the seconds that the
// standstill detector compares, it may hide a gentle start.
constexpr double kMaxRandomWalk = 0.005, kCompared_s = 4.0;
constexpr double kMaxCarrierSpeed = 0.02;  // m/s, mean of a few seconds

// Returns the next multiple of the interval after `time`.
GpsTime next_instant(GpsTime time, double interval_s) {
  const std::int64_t interval = rounded_nanoseconds(interval_s);
  return GpsTime::from_nanoseconds((time.nanoseconds() / interval + 1) * interval);
}

// Speed along the direction of travel with its sigma, and the uncertainty of that direction.
struct ForwardMotion {
  double speed = 0.0, sigma = 0.0;                  // m/s
  double side_variance = 0.0, down_variance = 0.0;  // rad^2, of the direction across and down
};

ForwardMotion forward_motion(const Ekf& ekf, const Eigen::Vector3d& point_b) {
  constexpr int kSize = ekf_index::kSize, kAttitude = ekf_index::kAttitude;
  const TravelAxes axes = travel_axes(ekf.filter_state().vehicle);
  const BodyVelocity velocity = body_velocity(ekf.state(), ekf.body().measured_rate_b, point_b);
  const Eigen::Vector3d forward = axes.C_bv.col(0);
  const Eigen::Index known = kSize + static_cast<Eigen::Index>(ekf.filter_state().vehicle.size());
  const auto variance_of = [&](const auto& row) {
    const auto h = row.head(known);
    return std::max(0.0, h.dot(ekf.covariance().topLeftCorner(known, known) * h));
  };
  ForwardMotion motion;
  motion.speed = std::abs(forward.dot(velocity.v_b));
  ConstraintVector row = ConstraintVector::Zero();
  row.head<kSize>() = velocity.columns * forward;
  motion.sigma = std::sqrt(variance_of(row));
  const auto across = [&](int axis) {
    ConstraintVector turned = ConstraintVector::Zero();
    const Eigen::Vector3d axis_b = axes.C_bv.col(axis);
    turned.segment<3>(kAttitude) = ekf.state().q_eb * axis_b.cross(forward);
    if (known > kSize) {
      turned(kSize + ekf_index::kTravelYaw) = axes.d_yaw.col(axis).dot(forward);
      turned(kSize + ekf_index::kTravelPitch) = axes.d_pitch.col(axis).dot(forward);
    }
    return variance_of(turned);
  };
  motion.side_variance = across(1);
  motion.down_variance = across(2);
  return motion;
}

// Returns the speed and its sigma without a direction of travel: total speed, largest sigma of a
// component.
ForwardMotion any_motion(const Ekf& ekf) {
  const Eigen::Matrix3d velocity = velocity_covariance_e(ekf.covariance());
  return {ekf.state().v_e.norm(), std::sqrt(velocity.diagonal().maxCoeff())};
}

}  // namespace

MotionAiding::MotionAiding(const MotionAidingConfig& config, const GaussMarkov& accel_bias,
                           bool carriers)
    : config_(config),
      detector_(config.standstill),
      odometer_(config.constraints),
      constraint_monitor_(config.constraints.interval_s) {
  const double random_walk =
      accel_bias.sigma * std::sqrt(2.0 * kCompared_s / accel_bias.correlation_time_s);
  requires_carrier_speed_ =
      carriers && config.constraints.zero_velocity && random_walk > kMaxRandomWalk;
}

// Returns whether the carriers permit a standstill, or are not required.
bool MotionAiding::carriers_agree() const {
  return !requires_carrier_speed_ || (carrier_speed_ && *carrier_speed_ < kMaxCarrierSpeed);
}

void MotionAiding::reset() {
  detector_.reset();
  odometer_.reset();
  next_ = GpsTime();
  constraint_monitor_.reset();
  standing_ = false;
  few_satellites_ = true;
  carrier_speed_.reset();
  clear_instants();
}

void MotionAiding::clear_instants() {
  instants_.clear();
  instants_complete_ = true;
}

void MotionAiding::report(GpsTime time) {
  for (const MotionMeasurement& m : measurements_) {
    if (reports_.size() == reports_.capacity()) return;
    const double sigma = std::sqrt(m.innovation_variance);
    reports_.push_back({time, m.component, m.observation, m.innovation, m.innovation_variance,
                        sigma > 0.0 ? std::abs(m.innovation) / sigma : 0.0, m.used, m.left});
  }
}

void MotionAiding::predict(std::span<const ImuSample> block,
                           std::span<const OdometerIncrement> odometer, GpsTime time, Ekf* ekf) {
  reports_.clear();
  if (config_.constraints.odometer) odometer_.add(odometer);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < block.size() && enabled(); ++i) {
    const ImuSample& sample = block[i];
    if (sample.interval_ns <= 0 || sample.time > time) continue;
    detector_.add(sample);
    const double interval_s = config_.constraints.interval_s;
    if (!next_.is_set() || sample.time > next_.plus_seconds(interval_s))
      next_ = next_instant(sample.time, interval_s);
    if (sample.time < next_) continue;
    next_ = next_instant(sample.time, interval_s);
    ekf->predict(block.subspan(begin, i + 1 - begin), sample.time, odometer_.follow(*ekf));
    begin = i + 1;
    constrain(ekf);
  }
  ekf->predict(block.subspan(begin), time, odometer_.follow(*ekf));
}

void MotionAiding::constrain(Ekf* ekf) {
  if (!ekf->initialized() || !ekf->has_attitude()) {
    odometer_.take(ekf->state().time, 0.0);  // discarded: there is no attitude
    return;
  }
  const NavState& state = ekf->state();
  const MotionConstraintConfig& constraints = config_.constraints;
  const ForwardMotion forward =
      constraints.non_holonomic ? forward_motion(*ekf, constraints.point_b) : any_motion(*ekf);
  ConstraintInstant instant;
  instant.time = state.time;
  instant.odometer = odometer_.take(state.time, forward.sigma);
  if (instant.odometer.known) ekf->estimate_constant(ekf_index::kOdometerScale);
  instant.stationary_rate_b = detector_.rate_b();
  const Eigen::Vector3d rest_b =
      state.errors.gyro_bias_b +
      state.q_eb.conjugate() * Eigen::Vector3d(0.0, 0.0, kEarthRotationRate);
  const double sigma_factor = few_satellites_ && !standing_ ? kFewSatellites : 1.0;
  standing_ = config_.constraints.zero_velocity && carriers_agree() &&
              !odometer_.moved(state.time) &&
              detector_.stands(rest_b, forward.speed, sigma_factor * forward.sigma);
  instant.standing = standing_;
  // The error of the speed lasts long, so that many instants together hold no more information than
  // one.
  const double excess = std::max(0.0, forward.sigma - kSatellitesSpeed);
  const double second_order = kCorrelationTime_s / constraints.interval_s * excess * excess;
  instant.side_second_order_variance = second_order * forward.side_variance;
  instant.vertical_second_order_variance = second_order * forward.down_variance;
  motion_measurements(config_.constraints, instant, ekf->filter_state(),
                      ekf->body().measured_rate_b, &measurements_);
  instant.used = ekf->constrain(&measurements_, config_.constraints.gate);
  report(instant.time);
  constraint_monitor_.add(measurements_, instant.used);
  if (instants_.size() == instants_.capacity()) {
    instants_complete_ = false;
    return;
  }
  instants_.push_back(instant);
}

}  // namespace leonav
