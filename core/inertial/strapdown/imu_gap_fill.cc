#include "core/inertial/strapdown/imu_gap_fill.h"

namespace leonav {
namespace {

using Eigen::Vector3d;

// 1 sigma of a vehicle's motion. Between two neighbours only the deviation from a straight line
// counts; with one neighbour alone the change of the rates is unknown, which kOneSided allows for.
constexpr double kAngularAcceleration = 0.5;  // rad/s^2
constexpr double kJerk = 5.0;                 // m/s^3
constexpr double kOneSided = 4.0;

double seconds_to_middle(const ImuSample& sample, GpsTime reference) {
  return seconds_between(sample.time, reference) - 0.5 * sample.interval_s();
}

}  // namespace

std::optional<ImuGapFill> fill_imu_gap(const ImuSample& previous, GpsTime from, GpsTime to,
                                       const ImuSample& next) {
  const bool has_previous = previous.interval_ns > 0;
  const bool has_next = next.interval_ns > 0;
  const GpsTime begin = has_previous ? previous.time : from;
  const GpsTime end = has_next ? next.start() : to;
  const bool within = begin <= from && from < to && to <= end;
  if (!within || !(has_previous || has_next) || seconds_between(end, begin) > kMaxImuGap_s)
    return std::nullopt;

  const ImuSample& before = has_previous ? previous : next;
  const ImuSample& after = has_next ? next : previous;
  const double dt = seconds_between(to, from);
  double share = 0.0;  // weight of `after`
  if (has_previous && has_next)
    share = (0.5 * dt - seconds_to_middle(before, from)) /
            (seconds_to_middle(after, from) - seconds_to_middle(before, from));
  const Vector3d rate = before.delta_theta_b / before.interval_s();
  const Vector3d force = before.delta_velocity_b / before.interval_s();
  const Vector3d rate_change = after.delta_theta_b / after.interval_s() - rate;
  const Vector3d force_change = after.delta_velocity_b / after.interval_s() - force;

  ImuGapFill gap_fill;
  gap_fill.sample.time = to;
  gap_fill.sample.interval_ns = to.nanoseconds() - from.nanoseconds();
  gap_fill.sample.delta_theta_b = dt * (rate + share * rate_change);
  gap_fill.sample.delta_velocity_b = dt * (force + share * force_change);
  const double unseen = 0.5 * dt * dt * (has_previous && has_next ? 1.0 : kOneSided);
  gap_fill.sigma_theta_b =
      0.5 * dt * rate_change.cwiseAbs().array() + unseen * kAngularAcceleration;
  gap_fill.sigma_velocity_b = 0.5 * dt * force_change.cwiseAbs().array() + unseen * kJerk;
  return gap_fill;
}

}  // namespace leonav
