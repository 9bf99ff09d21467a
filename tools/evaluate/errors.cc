#include "tools/evaluate/errors.h"

#include <algorithm>
#include <cmath>

#include "core/earth/rotation.h"

namespace leonav {

// Linear interpolation of latitude, longitude and height between neighbours differs from that in
// ECEF by less than a millimetre; with velocities at both ends a cubic removes the chord error in
// turns.
std::optional<TrackPoint> truth_at(const Track& truth, GpsTime time, double max_gap_s) {
  auto after = std::lower_bound(truth.begin(), truth.end(), time,
                                [](const TrackPoint& p, GpsTime t) { return p.time < t; });
  if (after == truth.end()) return std::nullopt;
  if (after->time == time) return *after;
  if (after == truth.begin()) return std::nullopt;
  const TrackPoint& a = *(after - 1);
  const TrackPoint& b = *after;
  const double gap = seconds_between(b.time, a.time);
  if (gap > max_gap_s) return std::nullopt;
  const double s = seconds_between(time, a.time) / gap;
  const Eigen::Vector3d pa = to_ecef(a.position), pb = to_ecef(b.position);
  Eigen::Vector3d p = pa + s * (pb - pa);
  if (a.v_n && b.v_n) {
    const Eigen::Vector3d va = rotation_ecef_to_ned(a.position).transpose() * *a.v_n;
    const Eigen::Vector3d vb = rotation_ecef_to_ned(b.position).transpose() * *b.v_n;
    const double r = 1.0 - s;
    p = r * r * (1.0 + 2.0 * s) * pa + s * s * (3.0 - 2.0 * s) * pb +
        s * r * gap * (r * va - s * vb);
  }
  TrackPoint out;
  out.time = time;
  out.position = to_geodetic(p);
  if (a.v_n && b.v_n) out.v_n = *a.v_n + s * (*b.v_n - *a.v_n);
  for (std::size_t i = 0; i < 3; ++i) {
    if (a.rpy[i] && b.rpy[i]) {
      out.rpy[i] = wrap_to_pi(*a.rpy[i] + s * wrap_to_pi(*b.rpy[i] - *a.rpy[i]));
    }
  }
  return out;
}

namespace {

std::optional<double> course_of(const TrackPoint& truth, const ErrorOptions& options) {
  if (!truth.v_n || !(truth.v_n->head<2>().norm() >= options.course_speed_m_s)) return std::nullopt;
  return std::atan2(truth.v_n->y(), truth.v_n->x());
}

ErrorSample error_of(const TrackPoint& solution, TrackPoint truth, const ErrorOptions& options) {
  ErrorSample sample;
  sample.time = solution.time;
  truth.position.height += options.antenna_offset_up_m;
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(truth.position);
  const Eigen::Vector3d ned = C_ne * (to_ecef(solution.position) - to_ecef(truth.position));
  sample.neu = {ned.x(), ned.y(), -ned.z()};
  sample.sigma_neu = solution.sigma_neu;
  sample.sigma_yaw = solution.sigma_yaw;
  sample.levels = solution.levels;
  if (solution.v_n && truth.v_n) {
    const Eigen::Vector3d v = *solution.v_n - *truth.v_n;
    sample.velocity_neu = Eigen::Vector3d(v.x(), v.y(), -v.z());
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (solution.rpy[i] && truth.rpy[i])
      sample.rpy[i] = wrap_to_pi(*solution.rpy[i] - *truth.rpy[i]);
  }
  const auto course = course_of(truth, options);
  if (solution.rpy[2] && !truth.rpy[2] && course) {
    sample.rpy[2] = wrap_to_pi(*solution.rpy[2] - *course);
    sample.yaw_from_course = true;
  }
  return sample;
}

double median_interval(const Track& track) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < track.size(); ++i) {
    steps.push_back(seconds_between(track[i].time, track[i - 1].time));
  }
  if (steps.empty()) return 0.0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<long>(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
}

}  // namespace

std::optional<double> course_at(const Track& truth, GpsTime time, const ErrorOptions& options) {
  const auto point = truth_at(truth, time, options.max_truth_gap_s);
  return point ? course_of(*point, options) : std::nullopt;
}

bool course_is_steady(const Track& truth, GpsTime time, const ErrorOptions& options) {
  if (!options.max_course_rate) return false;
  // The turn is taken in two steps, so that up to half a turn within each second is unambiguous.
  const auto before = course_at(truth, time.plus_nanoseconds(-1'000'000'000), options);
  const auto now = course_at(truth, time, options);
  const auto after = course_at(truth, time.plus_nanoseconds(1'000'000'000), options);
  if (!before || !now || !after) return false;
  const double turn = wrap_to_pi(*now - *before) + wrap_to_pi(*after - *now);
  return std::abs(turn) / 2.0 < *options.max_course_rate;
}

Comparison compare(const Track& solution, const Track& truth, const ErrorOptions& options) {
  Comparison comparison;
  comparison.interval_s = median_interval(solution);
  const GpsTime from = std::max(truth.front().time, options.from.value_or(truth.front().time));
  const GpsTime to = std::min(truth.back().time, options.to.value_or(truth.back().time));
  const auto epochs_in = [&](GpsTime begin, GpsTime end) -> std::size_t {
    if (comparison.interval_s <= 0.0 || end < begin) return 0;
    return static_cast<std::size_t>(seconds_between(end, begin) / comparison.interval_s + 0.01) + 1;
  };
  comparison.expected_in_truth = epochs_in(from, to);
  // Stamps of one epoch may differ by a millisecond. A solution less than half an interval outside
  // the truth therefore belongs to its first or last epoch, though there is nothing to compare it
  // with.
  const double half_s = 0.5 * std::min(comparison.interval_s, median_interval(truth));
  GpsTime first = from, last = to;  // the evaluated span; it contains the truth's span
  const auto is_judged = [&](GpsTime time) {
    if ((options.from && time < *options.from) || (options.to && time > *options.to)) return false;
    return time >= from ? time <= to || seconds_between(time, to) < half_s
                        : seconds_between(from, time) < half_s;
  };
  for (const TrackPoint& point : solution) {
    if (!is_judged(point.time)) continue;
    ++comparison.solution_epochs;
    first = std::min(first, point.time);
    last = std::max(last, point.time);
    const auto reference = truth_at(truth, point.time, options.max_truth_gap_s);
    if (!reference) {
      ++comparison.without_truth;
      continue;
    }
    comparison.errors.push_back(error_of(point, *reference, options));
    ErrorSample& sample = comparison.errors.back();
    sample.steady_course = sample.yaw_from_course && course_is_steady(truth, point.time, options);
  }
  comparison.expected_epochs =
      epochs_in(std::max(first, solution.front().time), std::min(last, solution.back().time));
  if (options.remove_offset && !comparison.errors.empty()) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const ErrorSample& sample : comparison.errors) sum += sample.neu;
    comparison.removed_offset_neu = sum / static_cast<double>(comparison.errors.size());
    for (ErrorSample& sample : comparison.errors) sample.neu -= comparison.removed_offset_neu;
  }
  return comparison;
}

}  // namespace leonav
