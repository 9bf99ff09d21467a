#include "core/inertial/alignment/alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/inertial/strapdown/imu_gap_fill.h"

namespace leonav {
namespace {

constexpr double kStandstillWindow_s = 1.0;
constexpr double kMaxUnconfirmed_s = 5.0;  // a velocity confirms at most this long a standstill
constexpr double kStaticTimeConstant_s = 2.0;
// The time constants are long against a step or a start at traffic lights, and short against the
// gyro drift that an unknown bias makes.
constexpr double kMovingTimeConstant_s = 10.0;
constexpr double kMovingKnownBiasTimeConstant_s = 30.0;

const Eigen::Vector3d kDown(0.0, 0.0, 1.0);

// Returns the shortest rotation that takes the direction of `from` into that of `to`.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d cross = from.cross(to);
  const double sine = cross.norm(), cosine = from.dot(to);
  if (sine < 1e-12 * std::abs(cosine)) {
    if (cosine > 0.0) return Eigen::Quaterniond::Identity();
    return quaternion_from_rotation_vector(EIGEN_PI * from.unitOrthogonal());
  }
  return quaternion_from_rotation_vector(std::atan2(sine, cosine) / sine * cross);
}

constexpr double kContradiction = 4.0;  // sigmas
constexpr double kGiveUpNorth = 3.0;    // times the duration that follows from the data sheet

}  // namespace

VelocityMatching::Config matching_config(const AlignmentConfig& config, const ImuErrorModel& imu) {
  VelocityMatching::Config matching;
  matching.window_s = config.matching_window_s;
  matching.lever_arm_b = config.lever_arm_b;
  matching.accel_bias_sigma = imu.accel_bias.sigma;
  matching.accel_scale_sigma = imu.accel_scale.sigma;
  return matching;
}

Alignment::Alignment(const AlignmentConfig& config, const ImuErrorModel& imu)
    : config_(config),
      imu_(imu),
      unconfirmed_static_gyro_(imu),
      static_gyro_(imu),
      static_gyro_since_move_(imu),
      matching_(matching_config(config, imu)) {}

void Alignment::reset() { *this = Alignment(config_, imu_); }

bool Alignment::levelled() const { return levelled_for_s_ > 0.0; }

void Alignment::add(const ImuSample& sample) {
  if (last_sample_.interval_ns > 0 && sample.start() > last_sample_.time) {
    const auto gap_fill = fill_imu_gap(last_sample_, last_sample_.time, sample.start(), sample);
    gap_fill ? propagate(gap_fill->sample) : reset();
  }
  propagate(sample);
  last_sample_ = sample;
}

void Alignment::propagate(const ImuSample& sample) {
  const Eigen::Vector3d turn = sample.delta_theta_b - static_gyro_.rate_b() * sample.interval_s();
  q_lb_ = (q_lb_ * quaternion_from_rotation_vector(turn)).normalized();
  if (config_.velocity_matching) {
    ImuSample unbiased = sample;
    unbiased.delta_theta_b = turn;
    matching_.add(unbiased);
  }
  if (levelled()) {
    refine_level(sample);
  } else {
    initialize_level(sample);
  }
  detect_standstill(sample);
}

// Until the first window is full, l is the body frame of its first sample.
void Alignment::initialize_level(const ImuSample& sample) {
  first_velocity_l_ += q_lb_ * sample.delta_velocity_b;
  first_s_ += sample.interval_s();
  if (first_s_ < config_.levelling_window_s) return;
  const Eigen::Vector3d force_l = first_velocity_l_ / first_s_;
  implausible_ = !(std::abs(force_l.norm() - kLevellingGravity) < 0.3 * kLevellingGravity);
  if (!implausible_) {
    q_lb_ = (rotation_between(-force_l, kDown) * q_lb_).normalized();
    levelled_for_s_ = first_s_;
  }
  first_velocity_l_.setZero();
  first_s_ = 0.0;
}

// Turns l so that the mean specific force points up. The correction is linear in the specific
// force, so that the accelerations of steps and bumps average out.
void Alignment::refine_level(const ImuSample& sample) {
  const double dt = sample.interval_s();
  levelled_for_s_ += dt;
  const Eigen::Vector3d velocity_l = q_lb_ * sample.delta_velocity_b;
  // The standstill ends with the first push, not with the window that detects it.
  const bool pushed = std::hypot(velocity_l.x(), velocity_l.y()) > config_.static_accel_m_s2 * dt;
  const double moving =
      static_gyro_.known() ? kMovingKnownBiasTimeConstant_s : kMovingTimeConstant_s;
  const double time_constant = window_is_static_ && !pushed ? kStaticTimeConstant_s : moving;
  const double gain = 1.0 / (kLevellingGravity * std::min(time_constant, levelled_for_s_));
  Eigen::Vector3d correction = -gain * velocity_l.cross(kDown);
  const double limit = 0.1 * dt;  // rad: a shock must not tip the level over
  if (correction.norm() > limit) correction *= limit / correction.norm();
  q_lb_ = (quaternion_from_rotation_vector(correction) * q_lb_).normalized();
}

void Alignment::detect_standstill(const ImuSample& sample) {
  const double dt = sample.interval_s();
  window_.seconds += dt;
  window_.angle += sample.delta_theta_b;
  window_.velocity += sample.delta_velocity_b;
  window_.force_squared += sample.delta_velocity_b.squaredNorm() / dt;
  if (window_.seconds < kStandstillWindow_s) return;
  const Eigen::Vector3d force = window_.velocity / window_.seconds;
  const double variance = window_.force_squared / window_.seconds - force.squaredNorm();
  window_is_static_ = variance < config_.static_accel_m_s2 * config_.static_accel_m_s2 &&
                      window_.angle.norm() < config_.static_gyro_rad_s * window_.seconds;
  if (!window_is_static_) static_gyro_since_move_.clear();
  const Eigen::Vector3d rate = window_.angle / window_.seconds;
  if (window_is_static_ && static_gyro_.is_plausible(rate, window_.seconds)) {
    if (unconfirmed_static_gyro_.seconds() > kMaxUnconfirmed_s) unconfirmed_static_gyro_.clear();
    unconfirmed_static_gyro_.add(rate, window_.seconds);
  }
  window_ = Sums();
}

void Alignment::confirm_standstill(double speed_3d, double sigma_v) {
  const bool stood = unconfirmed_static_gyro_.seconds() > 0.0;
  if (stood && may_be_stationary(speed_3d, sigma_v, config_.min_course_speed_m_s)) {
    static_gyro_.add(unconfirmed_static_gyro_);
    static_gyro_since_move_.add(unconfirmed_static_gyro_);
    static_q_lb_ = q_lb_;
  }
  unconfirmed_static_gyro_.clear();
}

// At rest the gyros measure the Earth's rate, whose horizontal part points north:
//   heading = atan2(-w_y, w_x), sigma = sigma_w / (omega_ie cos latitude)  (Groves 2013, 5.6.2).
// A turntable, or a bias beyond its sigma, has not the length and inclination of the Earth's rate.
std::optional<Alignment::North> Alignment::gyrocompass(double latitude) const {
  constexpr double kLikely = 4.0;  // sigmas
  if (!static_gyro_since_move_.known()) return std::nullopt;
  const Eigen::Vector3d rate_l = static_q_lb_ * static_gyro_since_move_.mean_b();
  const double north = kEarthRotationRate * std::cos(latitude);
  const double down = -kEarthRotationRate * std::sin(latitude);
  const double sigma = static_gyro_since_move_.mean_sigma();
  const double heading_sigma = sigma / std::max(north, 1e-3 * kEarthRotationRate);
  if (!(heading_sigma < config_.max_gyrocompass_sigma)) return std::nullopt;
  if (std::abs(rate_l.head<2>().norm() - north) > kLikely * sigma) return std::nullopt;
  if (std::abs(rate_l.z() - down) > kLikely * sigma) return std::nullopt;
  return North{std::atan2(-rate_l.y(), rate_l.x()), heading_sigma};
}

// Returns how many seconds of standing gyros that meet their data sheet need to find north;
// infinite if they never can.
double Alignment::seconds_to_north(double latitude) const {
  const double enough =
      config_.max_gyrocompass_sigma * kEarthRotationRate * std::max(std::cos(latitude), 1e-3);
  const double left = enough * enough - imu_.gyro_bias.sigma * imu_.gyro_bias.sigma;
  if (!(left > 0.0)) return std::numeric_limits<double>::infinity();
  return imu_.angle_random_walk * imu_.angle_random_walk / left;
}

AlignmentNeed Alignment::need(double latitude) const {
  if (!levelled()) {
    if (implausible_) return {Lacking::kGravity};
    return {Lacking::kLevelling, config_.levelling_window_s - first_s_};
  }
  if (candidate_) {
    if (candidate_->another) return {Lacking::kAgreement};
    return {Lacking::kCourse,
            std::max(1.0, config_.confirming_s - (levelled_for_s_ - candidate_->since_s))};
  }
  if (const double driven_s = courses_.seconds(); driven_s > 0.0) {
    const double more_s = config_.course_window_s - driven_s;
    if (more_s > 0.0) return {Lacking::kCourse, more_s + config_.confirming_s};
    const auto agreement = courses_.agreement();
    const bool agrees = agreement && agreement->sigma < config_.max_course_sigma;
    return {agrees && gear_ == Gear::kUnknown ? Lacking::kGear : Lacking::kAgreement};
  }
  const double north_s = seconds_to_north(latitude);
  // A static window counts as standing before a velocity has confirmed it. Once the gyros had time
  // enough, they are taken not to find north.
  const double stood_s =
      std::max(static_gyro_since_move_.seconds(), window_is_static_ ? kStandstillWindow_s : 0.0);
  if (std::isfinite(north_s) && stood_s > 0.0 && stood_s < kGiveUpNorth * north_s + 5.0)
    return {Lacking::kNorth, std::max(1.0, north_s - stood_s)};
  return {Lacking::kDriving};
}

void Alignment::add_course(const Eigen::Vector3d& v_n, double sigma_v, double relative_yaw) {
  const auto last = last_heading_;
  last_heading_ = Heading{levelled_for_s_, relative_yaw};
  const double speed = std::hypot(v_n.x(), v_n.y());
  if (!(speed >= config_.min_course_speed_m_s) || !std::isfinite(sigma_v)) {
    gear_ = Gear::kUnknown;
    return courses_.clear();
  }
  if (!(speed < config_.max_reverse_speed_m_s + 3.0 * sigma_v)) gear_ = Gear::kForward;
  if (!last || !(levelled_for_s_ > last->time_s)) return;
  // An antenna at an arm r from the axis that the body turns about moves sideways by r * rate.
  // Swung on a circle, it always moves at right angles to the body's x axis, and such courses agree
  // with each other.
  const double rate =
      wrap_to_pi(relative_yaw - last->relative_yaw) / (levelled_for_s_ - last->time_s);
  const double across = std::hypot(sigma_v, config_.turning_arm_m * rate) / speed;
  courses_.add({levelled_for_s_, std::atan2(v_n.y(), v_n.x()), relative_yaw,
                std::hypot(across, config_.course_heading_sigma)});
}

// Decides between forward and reverse by the course and, where the velocity has changed, by the
// matching: two headings are carried until one is confirmed. Where the matching contradicts both,
// the wheels slide or the velocities are wrong, and no heading is returned.
std::optional<Alignment::MotionHeading> Alignment::heading_in_motion(double relative_yaw) {
  using Known = VelocityMatching::Heading;
  auto course = courses_.agreement();
  if (course && !(course->sigma < config_.max_course_sigma)) course.reset();
  if (config_.max_reverse_speed_m_s <= 0.0) gear_ = Gear::kForward;

  const double rate_sigma = static_gyro_.sigma();
  auto match = config_.velocity_matching ? matching_.match(rate_sigma) : std::nullopt;
  if (course && match) {
    const double off =
        std::abs(wrap_to_pi(match->heading.heading - relative_yaw - course->yaw_offset));
    const double limit = kContradiction * std::hypot(match->heading.sigma, course->sigma);
    const Gear found = off < 0.5 * kPi ? Gear::kForward : Gear::kReverse;
    const bool agree =
        std::min(off, kPi - off) < limit && (found == Gear::kForward || gear_ != Gear::kForward);
    if (agree) {
      gear_ = found;
    } else if (config_.max_reverse_speed_m_s > 0.0) {
      return std::nullopt;
    } else {
      course.reset();  // a craft that floats or flies also moves sideways
    }
  }
  if (course && gear_ == Gear::kUnknown) course.reset();
  if (course && gear_ == Gear::kReverse) course->yaw_offset = wrap_to_pi(course->yaw_offset + kPi);
  if (course && config_.velocity_matching)
    match = matching_.match(rate_sigma,
                            Known{wrap_to_pi(relative_yaw + course->yaw_offset), course->sigma});
  if (match && match->heading.sigma < config_.max_matching_sigma)
    return MotionHeading{match->heading.heading - relative_yaw, match->heading.sigma, match};
  if (course) return MotionHeading{course->yaw_offset, course->sigma, std::nullopt};
  return std::nullopt;
}

// Velocities from reflected signals also give a heading, but a different one a moment later. Two
// headings contradict each other if they differ by more than the smaller of their sigmas and the
// drift of gyros with an unknown bias in between.
std::optional<Alignment::MotionHeading> Alignment::confirm_over_time(
    std::optional<MotionHeading> found) {
  constexpr double kRounding_s = 1e-3;  // epochs lie on a grid up to this rounding
  constexpr double kLikelyDrift = 2.0;  // sigmas
  // in a tunnel, gyros of an unknown bias drift to any heading
  constexpr double kForgotten_s = 15.0;
  if (!found) {
    candidate_.reset();
    return std::nullopt;
  }
  if (candidate_ && levelled_for_s_ - candidate_->seen_s > kForgotten_s) candidate_.reset();
  const double for_s = candidate_ ? levelled_for_s_ - candidate_->since_s : 0.0;
  const double limit = candidate_ ? std::min(found->sigma, candidate_->sigma) +
                                        kLikelyDrift * static_gyro_.sigma() * for_s
                                  : 0.0;
  const bool another =
      candidate_ && std::abs(wrap_to_pi(found->turn_l - candidate_->turn_l)) > limit;
  if (!candidate_ || another)
    candidate_ = Candidate{levelled_for_s_, levelled_for_s_, found->turn_l, found->sigma, another};
  candidate_->seen_s = levelled_for_s_;
  if (levelled_for_s_ - candidate_->since_s < config_.confirming_s - kRounding_s)
    return std::nullopt;
  return found;
}

std::optional<AlignedAttitude> Alignment::attitude(
    const Eigen::Vector3d& p_e, const Eigen::Vector3d& v_e, double sigma_v,
    const std::optional<ExternalHeading::Heading>& given) {
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(p_e));
  const Eigen::Vector3d v_n = C_ne * v_e;
  confirm_standstill(v_n.norm(), sigma_v);
  if (!levelled()) return std::nullopt;

  if (config_.velocity_matching) matching_.add_velocity(v_n.head<2>(), sigma_v, q_lb_);
  EulerAngles angles = euler_from_rotation(q_lb_.toRotationMatrix());
  add_course(v_n, sigma_v, angles.yaw);
  double turn_l = 0.0, heading_sigma = 0.0, level_sigma = config_.levelling_sigma;
  bool by_north = false;
  if (given) {
    turn_l = given->heading - angles.yaw;
    heading_sigma = given->sigma;
  } else if (const auto moving = confirm_over_time(heading_in_motion(angles.yaw))) {
    turn_l = moving->turn_l;
    heading_sigma = moving->sigma;
    if (moving->match && moving->match->level_sigma < level_sigma) {
      level_sigma = moving->match->level_sigma;
      const double yaw = angles.yaw;
      angles = euler_from_rotation(moving->match->q_lb.toRotationMatrix());
      angles.yaw = yaw;
    }
  } else if (const auto north = gyrocompass(to_geodetic(p_e).latitude)) {
    turn_l = north->turn_l;
    heading_sigma = north->sigma;
    by_north = true;
  } else {
    return std::nullopt;
  }

  angles.yaw = wrap_to_pi(angles.yaw + turn_l);
  const Eigen::Quaterniond q_en(Eigen::Matrix3d(C_ne.transpose()));
  AlignedAttitude aligned;
  aligned.q_eb = (q_en * Eigen::Quaterniond(rotation_from_euler(angles))).normalized();
  aligned.sigma_rpy << level_sigma, level_sigma, heading_sigma;
  aligned.gyro_bias_sigma = by_north ? imu_.gyro_bias.sigma : static_gyro_.sigma();
  // A standstill that has given north cannot give the bias too.
  if (static_gyro_.known() && !by_north) {
    // The Earth's rate during the standstill is not a gyro error.
    const Eigen::Quaterniond q_eb_standing =
        q_en * quaternion_from_rotation_vector(turn_l * kDown) * static_q_lb_;
    const Eigen::Vector3d omega_ie_b =
        q_eb_standing.conjugate() * Eigen::Vector3d(0.0, 0.0, kEarthRotationRate);
    aligned.gyro_bias_b = static_gyro_.rate_b() - omega_ie_b;
    aligned.gyro_bias_known = true;
  }
  return aligned;
}

}  // namespace leonav
