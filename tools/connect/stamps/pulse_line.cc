#include "tools/connect/stamps/pulse_line.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

constexpr double kOddSigmas = 5.0, kLeastOdd_ns = 0.3e6;

}  // namespace

void PulseLine::clear() {
  points_.clear();
  odd_.clear();
  has_origin_ = false;
  last_ = GpsTime();
}

void PulseLine::add(std::int64_t clock_ns, GpsTime time, double sigma_s) {
  if (last_.is_set() && nanoseconds_between(time, last_) < kApart_ns) return;
  last_ = time;
  if (!has_origin_) {
    has_origin_ = true;
    clock_origin_ns_ = clock_ns;
    gps_origin_ = time;
  }
  const std::int64_t x_ns = clock_ns - clock_origin_ns_;
  const std::int64_t y_ns = nanoseconds_between(time, gps_origin_) - x_ns;
  const Point point{static_cast<double>(x_ns), static_cast<double>(y_ns), sigma_s};
  if (is_ready()) {
    const double off_ns = point.y_ns - offset_at(point.x_ns);
    if (std::abs(off_ns) > std::max(kOddSigmas * this->sigma_s(clock_ns) * 1e9, kLeastOdd_ns)) {
      const bool same_sense =
          odd_.empty() || (odd_.back().y_ns > offset_at(odd_.back().x_ns)) == (off_ns > 0.0);
      if (!same_sense) odd_.clear();
      odd_.push_back(point);
      if (odd_.size() >= kStepAfter) follow_step();
      return;
    }
  }
  odd_.clear();
  points_.push_back(point);
  if (points_.size() > kWindow) points_.pop_front();
  fit();
}

void PulseLine::follow_step() {
  ++steps_;
  last_step_s_ = (odd_.back().y_ns - offset_at(odd_.back().x_ns)) * 1e-9;
  points_ = odd_;
  odd_.clear();
  fit();
}

void PulseLine::fit() {
  const auto n = static_cast<double>(points_.size());
  mean_x_ = mean_y_ = slope_ = spread_ = 0.0;
  for (const Point& p : points_) {
    mean_x_ += p.x_ns / n;
    mean_y_ += p.y_ns / n;
  }
  double product = 0.0;
  for (const Point& p : points_) {
    spread_ += std::pow(p.x_ns - mean_x_, 2);
    product += (p.x_ns - mean_x_) * (p.y_ns - mean_y_);
  }
  if (spread_ > 0.0) slope_ = std::clamp(product / spread_, -kMaxDrift, kMaxDrift);
  double residuals = 0.0, receiver = 0.0;
  for (const Point& p : points_) {
    residuals += std::pow(p.y_ns - offset_at(p.x_ns), 2);
    receiver += std::pow(p.sigma_s, 2);
  }
  residual_s_ = n > 2.0 ? std::sqrt(residuals / (n - 2.0)) * 1e-9 : 0.0;
  receiver_s_ = std::sqrt(receiver / n);
}

bool PulseLine::holds_at(std::int64_t clock_ns) const {
  if (!is_ready()) return false;
  const double since_ns = static_cast<double>(clock_ns - clock_origin_ns_) - points_.back().x_ns;
  return std::abs(since_ns) <= static_cast<double>(kHold_ns);
}

GpsTime PulseLine::gps_time(std::int64_t clock_ns) const {
  const std::int64_t x_ns = clock_ns - clock_origin_ns_;
  const auto offset_ns = std::llround(offset_at(static_cast<double>(x_ns)));
  return gps_origin_.plus_nanoseconds(x_ns + offset_ns);
}

double PulseLine::sigma_s(std::int64_t clock_ns) const {
  const double x_ns = static_cast<double>(clock_ns - clock_origin_ns_) - mean_x_;
  const double lever = spread_ > 0.0 ? x_ns * x_ns / spread_ : 0.0;
  const double of_line =
      residual_s_ * std::sqrt(1.0 + 1.0 / static_cast<double>(points_.size()) + lever);
  return std::hypot(of_line, receiver_s_);
}

}  // namespace leonav
