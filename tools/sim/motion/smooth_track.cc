#include "tools/sim/motion/smooth_track.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/earth/rotation.h"

namespace leonav {
namespace {

// Returns courses at the truth's times. At rest the last one is held, and the body turns to the
// next one just before it starts. `moving` marks the courses that count; they are unwrapped.
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

Eigen::Vector3d position_at(const MotionSplines& splines, double t) {
  const auto& p = splines.position;
  return {p[0].evaluate(t).value, p[1].evaluate(t).value, p[2].evaluate(t).value};
}

Eigen::Vector3d velocity_at(const MotionSplines& splines, double t) {
  const auto& p = splines.position;
  return {p[0].evaluate(t).first, p[1].evaluate(t).first, p[2].evaluate(t).first};
}

}  // namespace

SmoothTrack::SmoothTrack(const std::vector<TruthPoint>& points, const SmoothTrackOptions& options)
    : options_(options) {
  constexpr std::size_t kMinPoints = 20;
  if (points.size() < kMinPoints) {
    throw std::runtime_error("the truth has " + std::to_string(points.size()) +
                             " usable points; at least 20 are needed");
  }
  splines_.start = points.front().time;
  std::vector<double> intervals;
  for (std::size_t i = 0; i < points.size(); ++i) {
    times_.push_back(seconds_between(points[i].time, splines_.start));
    if (i == 0) continue;
    intervals.push_back(times_[i] - times_[i - 1]);
    if (intervals.back() > options_.max_gap_s) {
      throw std::runtime_error(
          "the truth has a hole of " + std::to_string(intervals.back()) +
          " s before time of week " + std::to_string(points[i].time.tow_s()) +
          "; cut the file there or allow wider holes (--max-gap, route.max_gap_s)");
    }
  }
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  splines_.duration_s = times_.back();
  fit_position(points, *middle);
  fit_attitude(*middle);
  motion_ = SplineMotion(std::move(splines_));
}

void SmoothTrack::fit_position(const std::vector<TruthPoint>& points, double interval_s) {
  splines_.origin_e = to_ecef(points.front().position);
  std::vector<Eigen::Vector3d> given;
  for (const TruthPoint& p : points) given.emplace_back(to_ecef(p.position) - splines_.origin_e);
  const double lambda = SmoothingSpline::lambda_for_cutoff(options_.position_cutoff_hz, interval_s);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : given) values.push_back(p[axis]);
    splines_.position[static_cast<std::size_t>(axis)] = SmoothingSpline(times_, values, lambda);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const double deviation = (position_at(splines_, times_[i]) - given[i]).norm();
    sum += deviation * deviation;
    max_deviation_m_ = std::max(max_deviation_m_, deviation);
  }
  rms_deviation_m_ = std::sqrt(sum / static_cast<double>(given.size()));
}

void SmoothTrack::fit_attitude(double interval_s) {
  std::vector<double> course, slope;
  std::vector<bool> moving;
  for (const double t : times_) {
    const Eigen::Vector3d p_e = splines_.origin_e + position_at(splines_, t);
    const Eigen::Vector3d v_n = rotation_ecef_to_ned(to_geodetic(p_e)) * velocity_at(splines_, t);
    const double speed = std::hypot(v_n.x(), v_n.y());
    moving.push_back(speed > options_.min_course_speed_m_s);
    course.push_back(std::atan2(v_n.y(), v_n.x()));
    slope.push_back(
        std::clamp(std::atan2(-v_n.z(), speed), -options_.max_slope, options_.max_slope));
  }
  const double lambda = SmoothingSpline::lambda_for_cutoff(options_.attitude_cutoff_hz, interval_s);
  const double rate = options_.max_turn_rate_rad_s;
  splines_.attitude[0] = SmoothingSpline(times_, std::vector<double>(times_.size(), 0.0), 0.0);
  splines_.attitude[1] = SmoothingSpline(times_, held_heading(times_, slope, moving, rate), lambda);
  splines_.attitude[2] =
      SmoothingSpline(times_, held_heading(times_, course, moving, rate), lambda);
}

}  // namespace leonav
