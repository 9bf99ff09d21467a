#include "core/filter/estimate/speed_history.h"

#include <algorithm>

#include "core/filter/update/motion_constraint.h"

namespace leonav {
namespace {

constexpr double kMaxHole_s = 0.1;

}  // namespace

void SpeedHistory::add(const FilterState& state, const Eigen::Vector3d& measured_rate_b) {
  const GpsTime time = state.nav.time;
  if (!speeds_.empty()) {
    const double since_s = seconds_between(time, speeds_.back().time);
    if (since_s == 0.0) return;
    if (!(since_s > 0.0 && since_s < kMaxHole_s)) clear();
  }
  speeds_.push_back({time, forward_speed(state, measured_rate_b, point_b_)});
}

void SpeedHistory::correct(const FilterState& state, const Eigen::Vector3d& measured_rate_b) {
  if (speeds_.empty() || speeds_.back().time != state.nav.time) {
    clear();
    return add(state, measured_rate_b);
  }
  const double wrong = forward_speed(state, measured_rate_b, point_b_) - speeds_.back().m_s;
  if (wrong == 0.0) return;
  for (Speed& speed : speeds_) speed.m_s += wrong;
}

// The speed is taken as straight between two that are kept.
std::optional<double> SpeedHistory::distance(GpsTime from, GpsTime to) const {
  if (speeds_.empty() || from < speeds_.front().time || to > speeds_.back().time)
    return std::nullopt;
  const auto first = std::partition_point(speeds_.begin(), speeds_.end(),
                                          [&](const Speed& speed) { return speed.time <= from; });
  double way_m = 0.0;
  for (auto after = first; after != speeds_.end() && (after - 1)->time < to; ++after) {
    const auto before = after - 1;
    const double span_s = seconds_between(after->time, before->time);
    const double begin = seconds_between(std::max(from, before->time), before->time) / span_s;
    const double end = seconds_between(std::min(to, after->time), before->time) / span_s;
    const double middle = 0.5 * (begin + end);
    way_m += (end - begin) * span_s * (before->m_s + middle * (after->m_s - before->m_s));
  }
  return way_m;
}

}  // namespace leonav
