#include "tools/evaluate/internal/gyro_heading.h"

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

struct Difference {
  GpsTime time;
  double t = 0.0;      // s
  double angle = 0.0;  // rad, turned angle minus course, continuous along the fitted line
};

// Returns turned angle minus course wherever the truth has a course, unwrapped from neighbour to
// neighbour.
std::vector<Difference> differences(const std::vector<Turned>& turned, const Track& truth,
                                    const ErrorOptions& options, double delay_s) {
  std::vector<Difference> out;
  for (const TrackPoint& point : truth) {
    if (options.from && point.time < *options.from) continue;
    if (options.to && point.time > *options.to) continue;
    const auto course = course_at(truth, point.time, options);
    const auto angle = angle_at(
        turned,
        point.time.plus_nanoseconds(static_cast<std::int64_t>(std::llround(delay_s * 1e9))));
    if (!course || !angle) continue;
    const double last = out.empty() ? 0.0 : out.back().angle;
    out.push_back({point.time, seconds_between(point.time, turned.front().time),
                   last + wrap_to_pi(*angle - *course - last)});
  }
  if (out.size() < 3) throw std::runtime_error("IMU and the truth's courses have no common time");
  return out;
}

struct Line {
  Distribution residuals;  // rad
  double drift = 0.0;      // rad/s
};

// Fits offset + drift * time by least squares, repeated with every difference unwrapped to the
// fitted line. `differences` keeps these turns, so that a part of them can be fitted afterwards.
Line fit(std::vector<Difference>* differences) {
  Line line;
  std::vector<double> residuals(differences->size());
  const auto n = static_cast<double>(differences->size());
  for (int pass = 0; pass < 5; ++pass) {
    double t_mean = 0.0, mean = 0.0, covariance = 0.0, variance = 0.0;
    for (const Difference& d : *differences) {
      t_mean += d.t / n;
      mean += d.angle / n;
    }
    for (const Difference& d : *differences) {
      covariance += (d.t - t_mean) * (d.angle - mean);
      variance += (d.t - t_mean) * (d.t - t_mean);
    }
    line.drift = covariance / variance;
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      Difference& d = (*differences)[i];
      const double on_line = mean + line.drift * (d.t - t_mean);
      residuals[i] = wrap_to_pi(d.angle - on_line);
      d.angle = on_line + residuals[i];
    }
  }
  line.residuals = distribution_of(residuals);
  return line;
}

}  // namespace

GyroHeading evaluate_gyro_heading(std::span<const ImuSample> imu, const Track& truth,
                                  const ErrorOptions& options) {
  const std::vector<Turned> turned = integrate(imu);
  if (turned.empty()) throw std::runtime_error("no IMU samples");
  GyroHeading out;
  std::vector<Difference> all = differences(turned, truth, options, 0.0);
  const Line at_once = fit(&all);
  out.at_once = at_once.residuals;
  out.drift_rad_s = at_once.drift;
  std::erase_if(all,
                [&](const Difference& d) { return !course_is_steady(truth, d.time, options); });
  if (all.size() >= 3) out.steady = fit(&all).residuals;
  out.at_best_delay = out.at_once;
  for (int step = 1; step * kDelayStep_s <= kMaxDelay_s + 1e-9; ++step) {
    std::vector<Difference> delayed = differences(turned, truth, options, step * kDelayStep_s);
    const Distribution d = fit(&delayed).residuals;
    if (d.rmse >= out.at_best_delay.rmse) continue;
    out.at_best_delay = d;
    out.best_delay_s = step * kDelayStep_s;
  }
  return out;
}

}  // namespace leonav
