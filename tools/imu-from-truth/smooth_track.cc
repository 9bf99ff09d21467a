#include "smooth_track.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/earth/rotation.h"

namespace leonav {
namespace {

// Courses at the truth's times; where it stands, the last one is held and the body turns to the
// next one just before it starts. `moving` tells which courses count; they are unwrapped.
std::vector<double> held_heading(const std::vector<double>& times, std::vector<double> course,
                                 const std::vector<bool>& moving, double max_rate) {
  const std::size_t n = course.size();
  const auto first = std::find(moving.begin(), moving.end(), true);
  if (first == moving.end()) return std::vector<double>(n, 0.0);
  const std::size_t begin = static_cast<std::size_t>(first - moving.begin());
  std::fill(course.begin(), course.begin() + static_cast<std::ptrdiff_t>(begin), course[begin]);
  std::size_t last = begin;
  for (std::size_t i = begin + 1; i < n; ++i) {
    if (!moving[i]) {
      course[i] = course[last];
      continue;
    }
    const double turn = wrap_to_pi(course[i] - course[last]);
    course[i] = course[last] + turn;
    const double turn_s = std::abs(turn) / max_rate;
    for (std::size_t j = last + 1; j < i; ++j) {
      const double before_start = times[i] - times[j];
      if (before_start < turn_s) course[j] = course[i] - turn * before_start / turn_s;
    }
    last = i;
  }
  return course;
}

}  // namespace

SmoothTrack::SmoothTrack(const std::vector<TruthPoint>& points, const SmoothTrackOptions& options)
    : options_(options) {
  constexpr std::size_t kMinPoints = 20;
  if (points.size() < kMinPoints) {
    throw std::runtime_error("the truth has " + std::to_string(points.size()) +
                             " usable points; at least 20 are needed");
  }
  start_ = points.front().time;
  std::vector<double> intervals;
  for (std::size_t i = 0; i < points.size(); ++i) {
    times_.push_back(seconds_between(points[i].time, start_));
    if (i == 0) continue;
    intervals.push_back(times_[i] - times_[i - 1]);
    if (intervals.back() > options_.max_gap_s) {
      throw std::runtime_error("the truth has a hole of " + std::to_string(intervals.back()) +
                               " s before time of week " + std::to_string(points[i].time.tow_s()) +
                               "; cut the file there or raise --max-gap");
    }
  }
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  fit_position(points, *middle);
  fit_attitude(*middle);
}

void SmoothTrack::fit_position(const std::vector<TruthPoint>& points, double interval_s) {
  origin_e_ = to_ecef(points.front().position);
  std::vector<Eigen::Vector3d> given;
  for (const TruthPoint& p : points) given.emplace_back(to_ecef(p.position) - origin_e_);
  const double lambda = SmoothingSpline::lambda_for_cutoff(options_.position_cutoff_hz, interval_s);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : given) values.push_back(p[axis]);
    position_[static_cast<std::size_t>(axis)] = SmoothingSpline(times_, values, lambda);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const double deviation = (at(times_[i]).p_e - origin_e_ - given[i]).norm();
    sum += deviation * deviation;
    max_deviation_m_ = std::max(max_deviation_m_, deviation);
  }
  rms_deviation_m_ = std::sqrt(sum / static_cast<double>(given.size()));
}

void SmoothTrack::fit_attitude(double interval_s) {
  std::vector<double> course, slope;
  std::vector<bool> moving;
  for (const double t : times_) {
    const TrackInstant now = at(t);
    const Eigen::Vector3d v_n = rotation_ecef_to_ned(to_geodetic(now.p_e)) * now.v_e;
    const double speed = std::hypot(v_n.x(), v_n.y());
    moving.push_back(speed > options_.min_course_speed_m_s);
    course.push_back(std::atan2(v_n.y(), v_n.x()));
    slope.push_back(
        std::clamp(std::atan2(-v_n.z(), speed), -options_.max_slope, options_.max_slope));
  }
  const double lambda = SmoothingSpline::lambda_for_cutoff(options_.attitude_cutoff_hz, interval_s);
  const double rate = options_.max_turn_rate_rad_s;
  yaw_ = SmoothingSpline(times_, held_heading(times_, course, moving, rate), lambda);
  pitch_ = SmoothingSpline(times_, held_heading(times_, slope, moving, rate), lambda);
}

TrackInstant SmoothTrack::at(double t) const {
  TrackInstant now;
  for (int axis = 0; axis < 3; ++axis) {
    const SmoothingSpline& spline = position_[static_cast<std::size_t>(axis)];
    now.p_e[axis] = origin_e_[axis] + spline.value(t);
    now.v_e[axis] = spline.first_derivative(t);
    now.a_e[axis] = spline.second_derivative(t);
  }
  return now;
}

Eigen::Quaterniond SmoothTrack::attitude(double t) const {
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(at(t).p_e));
  const Eigen::Matrix3d C_nb = rotation_from_euler({0.0, pitch_.value(t), yaw_.value(t)});
  return Eigen::Quaterniond(Eigen::Matrix3d(C_ne.transpose() * C_nb)).normalized();
}

// Earth rate, the local frame's turning with the ellipsoid's curvature (Groves 2013, eq. 5.44), and
// the rates of yaw and pitch about their axes; roll is zero.
Eigen::Vector3d SmoothTrack::omega_ib_b(double t) const {
  const TrackInstant now = at(t);
  const Geodetic where = to_geodetic(now.p_e);
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(where);
  const Eigen::Vector3d v_n = C_ne * now.v_e;
  const double east_turn = v_n.y() / (prime_vertical_radius(where.latitude) + where.height);
  const double north_turn = v_n.x() / (meridian_radius(where.latitude) + where.height);
  const Eigen::Vector3d omega_en_n(east_turn, -north_turn, -east_turn * std::tan(where.latitude));
  const Eigen::Vector3d omega_in_n = kEarthRotationRate * C_ne.col(2) + omega_en_n;
  const double pitch = pitch_.value(t), yaw_rate = yaw_.first_derivative(t);
  const Eigen::Vector3d omega_nb_b(-yaw_rate * std::sin(pitch), pitch_.first_derivative(t),
                                   yaw_rate * std::cos(pitch));
  return rotation_from_euler({0.0, pitch, yaw_.value(t)}).transpose() * omega_in_n + omega_nb_b;
}

TruthPoint SmoothTrack::point(GpsTime time) const {
  const double t = seconds_between(time, start_);
  const TrackInstant now = at(t);
  TruthPoint point;
  point.time = time;
  point.position = to_geodetic(now.p_e);
  point.v_n = rotation_ecef_to_ned(point.position) * now.v_e;
  point.roll = 0.0;
  point.pitch = pitch_.value(t);
  point.yaw = wrap_to_pi(yaw_.value(t));
  return point;
}

}  // namespace leonav
