#include "tools/connect/stamps/envelope_line.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace leonav {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::size_t kStepAfter = 5, kLargeStepAfter = 2;
constexpr double kLargeStep_ns = 0.5e9;
// Messages that were held up are late by less, and none is ever so early.
bool is_surely_step(double off_ns) {
  return off_ns < -static_cast<double>(EnvelopeLine::kEarly_ns) ||
         off_ns > static_cast<double>(EnvelopeLine::kLate_ns);
}
// A second contradicts the line by more than this many sigmas, and more than this.
constexpr double kContradictingSigmas = 5.0, kLeastContradiction_ns = 2e6;

// Three years; a clock that is further away belongs to another line.
constexpr std::int64_t kFar_ns = 100'000'000'000'000'000;
constexpr int kFarReset = 20;  // messages in a row

std::int64_t second_of(std::int64_t clock_ns) {
  return clock_ns / kSecond_ns - (clock_ns % kSecond_ns < 0 ? 1 : 0);
}

}  // namespace

void EnvelopeLine::add(std::int64_t clock_ns, std::int64_t arrival_ns) {
  if (!has_origin_) {
    has_origin_ = true;
    clock_origin_ns_ = clock_ns;
    arrival_origin_ns_ = arrival_ns;
    second_ = second_of(clock_ns);
  }
  if (is_far(clock_ns)) {
    if (++far_ < kFarReset) return;
    const std::uint64_t steps = steps_ + 1;
    const double step_s = static_cast<double>(clock_origin_ns_ - clock_ns) * 1e-9;
    *this = EnvelopeLine();
    steps_ = steps;
    last_step_s_ = step_s;
    return add(clock_ns, arrival_ns);
  }
  far_ = 0;
  if (const std::int64_t second = second_of(clock_ns); second != second_) {
    close_second();
    second_ = second;
  }
  const auto x_ns = static_cast<double>(clock_ns - clock_origin_ns_);
  const Point point{x_ns, static_cast<double>(arrival_ns - arrival_origin_ns_) - x_ns};
  if (!earliest_ || point.delay_ns < earliest_->delay_ns) earliest_ = point;
}

bool EnvelopeLine::is_far(std::int64_t clock_ns) const {
  const std::int64_t x_ns = clock_ns - clock_origin_ns_;
  return x_ns > kFar_ns || x_ns < -kFar_ns;
}

void EnvelopeLine::close_second() {
  if (!earliest_) return;
  const Point point = *earliest_;
  earliest_.reset();
  const double off_ns = point.delay_ns - delay_at(point.x_ns);
  const double odd_ns = std::max(kContradictingSigmas * sigma_s_ * 1e9, kLeastContradiction_ns);
  // While the line has no slope yet it may be off by more than its sigma says.
  const bool is_settled = points_.size() >= kSlopeAfter;
  const bool is_odd = std::abs(off_ns) > (is_settled ? odd_ns : static_cast<double>(kEarly_ns));
  if (is_ready_ && is_odd) {
    const bool same_sense =
        odd_.empty() || (odd_.back().delay_ns > delay_at(odd_.back().x_ns)) == (off_ns > 0.0);
    if (!same_sense) odd_.clear();
    odd_.push_back(point);
    if (odd_.size() >= (is_surely_step(off_ns) ? kLargeStepAfter : kStepAfter)) {
      follow_step();
    }
    return;
  }
  odd_.clear();
  if (!points_.empty() && point.x_ns <= points_.back().x_ns) {
    ++setbacks_;
    if (is_ready_) return;  // a line that holds learns nothing from it
    points_.clear();
  }
  points_.push_back(point);
  if (points_.size() > kWindow) points_.pop_front();
  fit();
}

void EnvelopeLine::follow_step() {
  ++steps_;
  last_step_s_ = (odd_.back().delay_ns - delay_at(odd_.back().x_ns)) * 1e-9;
  // A clock that was set back has points out of order: those before the last run are dropped.
  points_.clear();
  for (const Point& point : odd_) {
    if (!points_.empty() && (point.x_ns <= points_.back().x_ns ||
                             std::abs(point.delay_ns - points_.back().delay_ns) > kLargeStep_ns)) {
      points_.clear();
    }
    points_.push_back(point);
  }
  odd_.clear();
  fit();
}

void EnvelopeLine::fit() {
  if (!is_ready_ && points_.size() < kReadyAfter) return;
  const auto lowest_at_slope = [this](double slope) {
    double lowest = points_.front().delay_ns - slope * points_.front().x_ns;
    for (const Point& p : points_) lowest = std::min(lowest, p.delay_ns - slope * p.x_ns);
    return lowest;
  };
  slope_ = 0.0;
  if (points_.size() >= kSlopeAfter) {
    double mean_x = 0.0;
    for (const Point& p : points_) mean_x += p.x_ns / static_cast<double>(points_.size());
    std::vector<Point> hull;
    for (const Point& p : points_) {
      const auto turns_right = [&p](const Point& a, const Point& b) {
        return (b.x_ns - a.x_ns) * (p.delay_ns - a.delay_ns) <=
               (b.delay_ns - a.delay_ns) * (p.x_ns - a.x_ns);
      };
      while (hull.size() >= 2 && turns_right(hull[hull.size() - 2], hull.back())) hull.pop_back();
      hull.push_back(p);
    }
    std::size_t end = 1;
    while (end + 1 < hull.size() && hull[end].x_ns < mean_x) ++end;
    const Point &a = hull[end - 1], &b = hull[end];
    slope_ = std::clamp((b.delay_ns - a.delay_ns) / (b.x_ns - a.x_ns), -kMaxDrift, kMaxDrift);
  }
  offset_ns_ = lowest_at_slope(slope_);
  double sum = 0.0;
  for (const Point& p : points_) sum += std::pow(p.delay_ns - delay_at(p.x_ns), 2);
  sigma_s_ = std::sqrt(sum / static_cast<double>(points_.size())) * 1e-9;
  is_ready_ = true;
}

std::int64_t EnvelopeLine::arrival_ns(std::int64_t clock_ns) const {
  const std::int64_t x_ns = clock_ns - clock_origin_ns_;
  return arrival_origin_ns_ + x_ns + std::llround(delay_at(static_cast<double>(x_ns)));
}

std::int64_t EnvelopeLine::clock_ns(std::int64_t arrival_ns) const {
  const std::int64_t y_ns = arrival_ns - arrival_origin_ns_;
  // y = x + offset + slope x; the large part is subtracted as an integer.
  const double rest_ns = (offset_ns_ + slope_ * static_cast<double>(y_ns)) / (1.0 + slope_);
  return clock_origin_ns_ + y_ns - std::llround(rest_ns);
}

bool EnvelopeLine::agrees(std::int64_t clock_ns, std::int64_t arrival_ns) const {
  if (is_far(clock_ns)) return false;
  const std::int64_t late_ns = arrival_ns - this->arrival_ns(clock_ns);
  return late_ns > -kEarly_ns && late_ns < kLate_ns;
}

}  // namespace leonav
