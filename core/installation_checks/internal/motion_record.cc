#include "core/installation_checks/internal/motion_record.h"

#include <algorithm>
#include <cmath>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"

namespace leonav {
namespace {

constexpr double kLongest_s = 3.0;    // over longer times the mean is not informative
constexpr double kMinImuShare = 0.8;  // of the time

}  // namespace

void MotionRecord::clear() {
  seconds_.clear();
  last_time_ = GpsTime();
  last_velocity_.reset();
  angle_b_.setZero();
  velocity_b_.setZero();
  force_squared_ = imu_s_ = 0.0;
}

void MotionRecord::add(const ImuSample& sample) {
  angle_b_ += sample.delta_theta_b;
  velocity_b_ += sample.delta_velocity_b;
  imu_interval_s_ = sample.interval_s();
  imu_s_ += imu_interval_s_;
  force_squared_ += sample.delta_velocity_b.squaredNorm() / imu_interval_s_;
}

bool MotionRecord::is_due(GpsTime time) const {
  return !last_time_.is_set() || !(std::abs(seconds_between(time, last_time_)) < kShortest_s);
}

const MotionSecond* MotionRecord::end_second(GpsTime time, const PointSolution* point) {
  std::optional<Velocity> velocity;
  if (point != nullptr && point->has_velocity && point->v_e.allFinite()) {
    const Eigen::Vector3d v_n = rotation_ecef_to_ned(to_geodetic(point->p_e)) * point->v_e;
    velocity = Velocity{v_n.head<2>(), std::sqrt(point->covariance_v_e.trace() / 3.0)};
  }
  MotionSecond second;
  second.time = time;
  second.seconds = last_time_.is_set() ? seconds_between(time, last_time_) : 0.0;
  const bool ends = second.seconds > 0.0 && second.seconds <= kLongest_s;
  if (ends && imu_s_ >= kMinImuShare * second.seconds) {
    second.has_imu = true;
    second.force_b = velocity_b_ / imu_s_;
    second.rate_b = angle_b_ / imu_s_;
    second.force_mean_square = force_squared_ / imu_s_;
  }
  if (ends && velocity && last_velocity_) set_course(*last_velocity_, *velocity, &second);
  if (ends) seconds_.push_back(second);
  last_time_ = time;
  last_velocity_ = velocity;
  angle_b_.setZero();
  velocity_b_.setZero();
  force_squared_ = imu_s_ = 0.0;
  return ends ? &seconds_.back() : nullptr;
}

void MotionRecord::set_course(const Velocity& from, const Velocity& to,
                              MotionSecond* second) const {
  const Eigen::Vector2d mean = 0.5 * (from.north_east + to.north_east);
  second->speed = std::min(from.north_east.norm(), to.north_east.norm());
  const double sigma = std::max(from.sigma, to.sigma);
  if (!(second->speed >= limits_.min_speed_m_s) || !(sigma < limits_.max_sigma * second->speed))
    return;
  // A velocity that changes direction by more than this within a second does not show a heading.
  if (!(mean.norm() > 0.5 * second->speed)) return;
  const Eigen::Vector2d forward = mean.normalized(), right(-forward.y(), forward.x());
  const Eigen::Vector2d acceleration = (to.north_east - from.north_east) / second->seconds;
  second->has_course = true;
  second->along = acceleration.dot(forward);
  second->across = acceleration.dot(right);
  const double turn = std::atan2(to.north_east.y(), to.north_east.x()) -
                      std::atan2(from.north_east.y(), from.north_east.x());
  second->course_rate = wrap_to_pi(turn) / second->seconds;
}

}  // namespace leonav
