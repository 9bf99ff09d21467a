#include "tools/evaluation/gyro_heading.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/earth/rotation.h"

namespace leonav {
namespace {

constexpr double kLevelTime_s = 2.0;
constexpr double kMaxDelay_s = 1.0, kDelayStep_s = 0.05;

struct Turned {
  GpsTime time;
  double angle;  // rad, about the vertical, since the first sample; not wrapped
};

std::vector<Turned> integrate(std::span<const ImuSample> imu) {
  std::vector<Turned> turned;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  double angle = 0.0;
  for (const ImuSample& sample : imu) {
    const double dt = sample.interval_s();
    const Eigen::Vector3d now = sample.delta_velocity_b / dt;
    force = force.isZero() ? now : Eigen::Vector3d(force + dt / kLevelTime_s * (now - force));
    angle += sample.delta_theta_b.dot(-force.normalized());
    turned.push_back({sample.time, angle});
  }
  return turned;
}

std::optional<double> angle_at(const std::vector<Turned>& turned, GpsTime time) {
  const auto after = std::lower_bound(turned.begin(), turned.end(), time,
                                      [](const Turned& a, GpsTime t) { return a.time < t; });
  if (after == turned.begin() || after == turned.end()) return std::nullopt;
  const auto before = after - 1;
  const double share =
      seconds_between(time, before->time) / seconds_between(after->time, before->time);
  return before->angle + share * (after->angle - before->angle);
}

struct Fit {
  std::vector<double> residuals;  // rad
  std::vector<GpsTime> times;
  double drift = 0.0;  // rad/s
};

// Least squares of offset + drift * time; differences are angles, so the fit starts from
// neighbours unwrapped and is repeated with every difference taken on the fitted line's turn.
Fit fit(const std::vector<Turned>& turned, const Track& truth, const ErrorOptions& options,
        double delay_s) {
  Fit out;
  std::vector<double> at, difference;
  for (const TrackPoint& point : truth) {
    if (options.from && point.time < *options.from) continue;
    if (options.to && point.time > *options.to) continue;
    const auto course = course_at(truth, point.time, options);
    const auto angle = angle_at(
        turned,
        point.time.plus_nanoseconds(static_cast<std::int64_t>(std::llround(delay_s * 1e9))));
    if (!course || !angle) continue;
    const double last = difference.empty() ? 0.0 : difference.back();
    difference.push_back(last + wrap_to_pi(*angle - *course - last));
    at.push_back(seconds_between(point.time, turned.front().time));
    out.times.push_back(point.time);
  }
  if (at.size() < 3) throw std::runtime_error("IMU and the truth's courses have no common time");
  for (int pass = 0; pass < 5; ++pass) {
    const Eigen::Map<const Eigen::ArrayXd> t(at.data(), static_cast<Eigen::Index>(at.size()));
    const Eigen::Map<const Eigen::ArrayXd> d(difference.data(), t.size());
    const double t_mean = t.mean(), d_mean = d.mean();
    out.drift = ((t - t_mean) * (d - d_mean)).sum() / (t - t_mean).square().sum();
    out.residuals.clear();
    for (Eigen::Index i = 0; i < t.size(); ++i) {
      const double line = d_mean + out.drift * (t[i] - t_mean);
      out.residuals.push_back(wrap_to_pi(d[i] - line));
      difference[static_cast<std::size_t>(i)] = line + out.residuals.back();
    }
  }
  return out;
}

}  // namespace

GyroHeading judge_gyro_heading(std::span<const ImuSample> imu, const Track& truth,
                               const ErrorOptions& options) {
  const std::vector<Turned> turned = integrate(imu);
  if (turned.empty()) throw std::runtime_error("no IMU samples");
  GyroHeading out;
  const Fit at_once = fit(turned, truth, options, 0.0);
  out.at_once = distribution_of(at_once.residuals);
  out.drift_rad_s = at_once.drift;
  std::vector<double> steady;
  for (std::size_t i = 0; i < at_once.times.size(); ++i) {
    if (course_is_steady(truth, at_once.times[i], options)) steady.push_back(at_once.residuals[i]);
  }
  out.steady = distribution_of(steady);
  out.at_best_delay = out.at_once;
  for (int step = 1; step * kDelayStep_s <= kMaxDelay_s + 1e-9; ++step) {
    const Distribution d =
        distribution_of(fit(turned, truth, options, step * kDelayStep_s).residuals);
    if (d.rmse >= out.at_best_delay.rmse) continue;
    out.at_best_delay = d;
    out.best_delay_s = step * kDelayStep_s;
  }
  return out;
}

}  // namespace leonav
