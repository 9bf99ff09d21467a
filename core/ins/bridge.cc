#include "core/ins/bridge.h"

namespace leonav {
namespace {

using Eigen::Vector3d;

// Of a vehicle, 1 sigma. Between two neighbours only what deviates from a straight line counts;
// with one neighbour alone the change itself is unknown.
constexpr double kAngularAcceleration = 0.5;  // rad/s^2
constexpr double kJerk = 5.0;                 // m/s^3
constexpr double kOneSided = 4.0;

double seconds_to_middle(const ImuSample& sample, GpsTime reference) {
  return seconds_between(sample.time, reference) - 0.5 * sample.interval_s();
}

}  // namespace

std::optional<Bridge> bridge_hole(const ImuSample& previous, GpsTime from, GpsTime to,
                                  const ImuSample& next) {
  const bool has_previous = previous.interval_ns > 0;
  const bool has_next = next.interval_ns > 0;
  const GpsTime begin = has_previous ? previous.time : from;
  const GpsTime end = has_next ? next.start() : to;
  const bool within = begin <= from && from < to && to <= end;
  if (!within || !(has_previous || has_next) || seconds_between(end, begin) > kLongestBridge_s)
    return std::nullopt;

  const ImuSample& before = has_previous ? previous : next;
  const ImuSample& after = has_next ? next : previous;
  const double dt = seconds_between(to, from);
  double share = 0.0;  // of `after`
  if (has_previous && has_next)
    share = (0.5 * dt - seconds_to_middle(before, from)) /
            (seconds_to_middle(after, from) - seconds_to_middle(before, from));
  const Vector3d rate = before.delta_theta_b / before.interval_s();
  const Vector3d force = before.delta_velocity_b / before.interval_s();
  const Vector3d rate_change = after.delta_theta_b / after.interval_s() - rate;
  const Vector3d force_change = after.delta_velocity_b / after.interval_s() - force;

  Bridge bridge;
  bridge.filler.time = to;
  bridge.filler.interval_ns = to.nanoseconds() - from.nanoseconds();
  bridge.filler.delta_theta_b = dt * (rate + share * rate_change);
  bridge.filler.delta_velocity_b = dt * (force + share * force_change);
  const double unseen = 0.5 * dt * dt * (has_previous && has_next ? 1.0 : kOneSided);
  bridge.sigma_theta_b = 0.5 * dt * rate_change.cwiseAbs().array() + unseen * kAngularAcceleration;
  bridge.sigma_velocity_b = 0.5 * dt * force_change.cwiseAbs().array() + unseen * kJerk;
  return bridge;
}

}  // namespace leonav
