#include "core/navigator/monitors/heading_monitor.h"

#include <algorithm>
#include <cmath>

#include "core/base/angle.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

constexpr double kHeadingSigmas = 5.0;            // of the difference of the two headings
constexpr double kLeastOff = 10.0 * kPi / 180.0;  // rad; the filter corrects less by itself
// All velocities for so long, and at least so many, must contradict the heading. One that was
// confirmed has been kept by the gyros since: reflections pass in less, an error of the gyros does
// not.
constexpr double kContradicted_s = 2.0, kContradictedConfirmed_s = 29.0;
constexpr int kMinContradictions = 3;
constexpr double kStampTolerance_s = 0.1;  // of the instants of velocities
// Reflected Dopplers agree with each other for some seconds. A running filter is therefore reset
// only by courses over a longer window than an alignment needs.
constexpr double kCourseWindow_s = 10.0;
constexpr double kMinCourseSpeed = 3.0;                // m/s
constexpr double kMaxCourseSigma = 5.0 * kPi / 180.0;  // rad
// rad; velocity matching with a smaller sigma may confirm the filter's heading.
constexpr double kConfirming = 3.0 * kPi / 180.0;
constexpr double kConfirmed = 2.0;  // sigmas
constexpr double kMaxMisfit = 2.0;

double yaw_of(const Eigen::Quaterniond& q) { return euler_from_rotation(q.toRotationMatrix()).yaw; }

}  // namespace

HeadingMonitor::HeadingMonitor(const AlignmentConfig& config, const ImuErrorModel& imu)
    : config_(config), matching_(matching_config(config, imu)), courses_(kCourseWindow_s) {}

void HeadingMonitor::clear_windows() {
  matching_.reset();
  courses_.clear();
  last_course_.reset();
  last_time_ = GpsTime();
  consecutive_contradictions_ = 0;
}

void HeadingMonitor::start(const Eigen::Vector3d& gyro_bias_b, double gyro_bias_sigma) {
  clear_windows();
  started_ = true;
  confirmed_ = false;
  gyro_bias_b_ = gyro_bias_b;
  gyro_bias_sigma_ = gyro_bias_sigma;
}

void HeadingMonitor::add(std::span<const ImuSample> block) {
  if (!started_) return;
  for (const ImuSample& sample : block) {
    if (sample.interval_ns <= 0) continue;
    if (last_time_.is_set() && sample.start() > last_time_) {
      clear_windows();
      confirmed_ = false;  // the gyros have not kept it
    }
    last_time_ = sample.time;
    ImuSample unbiased = sample;
    unbiased.delta_theta_b -= gyro_bias_b_ * sample.interval_s();
    matching_.add(unbiased);
    q_lb_ = (q_lb_ * quaternion_from_rotation_vector(unbiased.delta_theta_b)).normalized();
    seconds_ += sample.interval_s();
  }
}

void HeadingMonitor::level(const Eigen::Quaterniond& q_nb) {
  EulerAngles angles = euler_from_rotation(q_nb.toRotationMatrix());
  angles.yaw = yaw_of(q_lb_);
  q_lb_ = Eigen::Quaterniond(rotation_from_euler(angles));
}

void HeadingMonitor::add_course(const Eigen::Vector2d& v_n, double sigma_v) {
  const double speed = v_n.norm(), yaw = yaw_of(q_lb_);
  if (!(speed >= kMinCourseSpeed)) {
    forward_ = false;
    last_course_.reset();
    return courses_.clear();
  }
  forward_ = forward_ || speed > config_.max_reverse_speed_m_s + 3.0 * sigma_v;
  if (last_course_ && seconds_ > last_course_->seconds) {
    const double rate = wrap_to_pi(yaw - last_course_->yaw) / (seconds_ - last_course_->seconds);
    const double across = std::hypot(sigma_v, config_.turning_arm_m * rate) / speed;
    courses_.add({seconds_, std::atan2(v_n.y(), v_n.x()), yaw,
                  std::hypot(across, config_.course_heading_sigma)});
  }
  last_course_ = Course{yaw, seconds_};
}

// Returns the heading by the courses minus `heading`. If the vehicle may be in reverse, it is the
// smaller of the differences for forward and reverse.
std::optional<double> HeadingMonitor::course_innovation(double heading) const {
  const auto agreement = courses_.agreement();
  if (!agreement || !(agreement->sigma < kMaxCourseSigma)) return std::nullopt;
  const double forward = wrap_to_pi(yaw_of(q_lb_) + agreement->yaw_offset - heading);
  const double reverse = wrap_to_pi(forward + kPi);
  return forward_ || std::abs(forward) < std::abs(reverse) ? forward : reverse;
}

std::optional<double> HeadingMonitor::add_velocity(const Eigen::Vector2d& v_n, double sigma_v,
                                                   const Filter& filter) {
  if (!started_ || !v_n.allFinite() || !std::isfinite(sigma_v)) return std::nullopt;
  if (!matching_.add_velocity(v_n, sigma_v, filter.q_nb)) return std::nullopt;
  const double heading = yaw_of(filter.q_nb);
  double off = 0.0;
  const auto test_deviation = [&](double angle, double sigma) {
    const double limit =
        std::max(kLeastOff, kHeadingSigmas * std::hypot(sigma, filter.heading_sigma));
    if (std::abs(angle) > limit) off = angle;
  };
  if (config_.max_reverse_speed_m_s > 0.0) {
    level(filter.q_nb);
    add_course(v_n, sigma_v);
    if (const auto course = course_innovation(heading))
      test_deviation(*course, courses_.agreement()->sigma);
  }
  const auto match = matching_.match(gyro_bias_sigma_);
  if (match && match->misfit < kMaxMisfit) {
    const double difference = wrap_to_pi(match->heading.heading - heading);
    test_deviation(difference, match->heading.sigma);
    // A filter whose heading is confirmed has a better gyro bias than at the start.
    const double both = std::hypot(match->heading.sigma, filter.heading_sigma);
    if (match->heading.sigma < kConfirming && std::abs(difference) < kConfirmed * both) {
      off = 0.0;
      confirmed_ = true;
      gyro_bias_b_ = filter.gyro_bias_b;
      gyro_bias_sigma_ = std::min(gyro_bias_sigma_, 3.0 * filter.gyro_bias_sigma);
    }
  }
  if (off == 0.0) {
    consecutive_contradictions_ = 0;
    return std::nullopt;
  }
  if (consecutive_contradictions_++ == 0) contradicted_since_ = seconds_;
  const double needed_s = confirmed_ ? kContradictedConfirmed_s : kContradicted_s;
  if (consecutive_contradictions_ < kMinContradictions ||
      seconds_ - contradicted_since_ < needed_s - kStampTolerance_s)
    return std::nullopt;
  clear_windows();
  return off;
}

}  // namespace leonav
