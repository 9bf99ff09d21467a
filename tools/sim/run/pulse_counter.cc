#include "tools/sim/run/pulse_counter.h"

#include <algorithm>
#include <cmath>

#include "core/earth/ellipsoid.h"

namespace leonav::sim {
namespace {

constexpr double kStep_s = 0.01;

}  // namespace

PulseCounter::PulseCounter(const OdometerConfig& config, const SplineMotion& motion)
    : config_(config),
      motion_(motion),
      speed_m_s_(forward_speed(0.0)),
      rolled_m_(0.5 * config.resolution_m) {}

double PulseCounter::forward_speed(double t) const {
  const MotionInstant now = motion_.at(t);
  const Eigen::Vector3d earth_b =
      now.q_eb.conjugate() * Eigen::Vector3d(0.0, 0.0, kEarthRotationRate);
  const Eigen::Vector3d v_b = now.q_eb.conjugate() * now.v_e;
  return (v_b + (now.omega_ib_b - earth_b).cross(config_.point_b)).x();
}

// Integrates the distance by the trapezoidal rule.
void PulseCounter::roll(double to_s) {
  while (now_s_ < to_s - 1e-9) {
    const double step_s = std::min(kStep_s, to_s - now_s_);
    const double speed = forward_speed(now_s_ + step_s);
    const double acceleration = (speed - speed_m_s_) / step_s;
    const double sense = speed < 0.0 ? -1.0 : 1.0;
    const bool locked = sense * acceleration < -config_.lock_braking_m_s2;
    const double slip = config_.slip_per_acceleration * sense * acceleration;
    if (!locked)
      rolled_m_ += 0.5 * (speed_m_s_ + speed) * step_s * (1.0 + config_.scale_error) * (1.0 + slip);
    speed_m_s_ = speed;
    now_s_ += step_s;
  }
}

bool PulseCounter::next(double until_s, OdometerIncrement* increment) {
  if (!(config_.rate_hz > 0.0)) return false;
  const auto nanoseconds = [this](long count) {
    return std::llround(static_cast<double>(count) / config_.rate_hz * 1e9);
  };
  const auto end_ns = nanoseconds(increments_ + 1);
  const double end_s = static_cast<double>(end_ns) * 1e-9;
  if (end_s > until_s || end_s > motion_.duration_s()) return false;
  roll(end_s);
  increment->time = motion_.start().plus_nanoseconds(end_ns);
  increment->interval_ns = end_ns - nanoseconds(increments_);
  ++increments_;
  const double before_m = counted_m_;
  counted_m_ = std::floor(rolled_m_ / config_.resolution_m) * config_.resolution_m;
  increment->distance_m = counted_m_ - before_m;
  increment->sign_known = config_.signed_pulses;
  if (!config_.signed_pulses) increment->distance_m = std::abs(increment->distance_m);
  return true;
}

}  // namespace leonav::sim
