#include "core/installation_checks/internal/yaw_rate_fit.h"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <cstddef>

#include "core/base/angle.h"
#include "core/installation_checks/stamp_offset_monitor.h"

namespace leonav {
namespace {

constexpr double kTurning = 0.05;      // rad/s; below, a lane change or noise
constexpr double kEnoughTurned = 1.0;  // rad
constexpr double kMuchTurned = 1.6;    // rad, for conclusions from missing agreement
constexpr double kFollows = 0.8, kDoesNotFollow = 0.3;  // squared correlation
constexpr int kMinTurningSeconds = 20;
constexpr double kLeastTurn = 0.7, kMostTurn = 1.4,
                 kHardlyTurn = 0.3;  // shares of the course's turn
constexpr int kLongestLag_s = 45;
constexpr double kClearlyBetter = 0.03;  // gain of the squared correlation

// Sums for the fit of a straight line, with the means removed.
class Line {
 public:
  void add(double x, double y) {
    ++n_;
    x_ += x;
    y_ += y;
    xx_ += x * x;
    xy_ += x * y;
    yy_ += y * y;
  }
  int count() const { return n_; }
  double slope() const { return sxx() > 0.0 ? sxy() / sxx() : 0.0; }
  double correlation() const {
    const double both = sxx() * (yy_ - y_ * y_ / n_);
    return both > 0.0 ? sxy() * sxy() / both : 0.0;
  }

 private:
  double sxx() const { return xx_ - x_ * x_ / n_; }
  double sxy() const { return xy_ - x_ * y_ / n_; }
  int n_ = 0;
  double x_ = 0.0, y_ = 0.0, xx_ = 0.0, xy_ = 0.0, yy_ = 0.0;
};

using Ratios = boost::container::static_vector<double, MotionRecord::kCapacity>;

double median(Ratios ratios) {
  if (ratios.empty()) return 0.0;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

bool is_right(double ratio) { return std::abs(ratio) > kLeastTurn && std::abs(ratio) < kMostTurn; }

bool is_later_by(const MotionSecond& later, const MotionSecond& earlier, int lag_s) {
  return std::abs(seconds_between(later.time, earlier.time) - lag_s) < 0.5;
}

}  // namespace

bool YawRateFit::follows() const {
  return seconds >= kMinTurningSeconds && turned >= kEnoughTurned && correlation >= kFollows;
}

bool YawRateFit::contradicts() const {
  return seconds >= kMinTurningSeconds && turned >= kMuchTurned && correlation <= kDoesNotFollow;
}

YawRateFit fit_yaw_rate(const MotionRecord& record, const Eigen::Vector3d& axis_b, int lag_s) {
  YawRateFit fit;
  Line line;
  Ratios ratios;
  GpsTime first;
  const auto& seconds = record.seconds();
  const int count = static_cast<int>(seconds.size());
  for (int i = std::max(0, -lag_s); i < count && i + lag_s < count; ++i) {
    const MotionSecond& course = seconds[static_cast<std::size_t>(i)];
    const MotionSecond& gyros = seconds[static_cast<std::size_t>(i + lag_s)];
    if (!course.has_course || !gyros.has_imu || !is_later_by(gyros, course, lag_s)) continue;
    if (!first.is_set()) first = course.time;
    fit.span_s = seconds_between(course.time, first);
    const double rate = axis_b.dot(gyros.rate_b);
    line.add(course.course_rate, rate);
    const double turn = std::abs(course.course_rate);
    if (!(turn > kTurning)) continue;
    fit.turned += turn * course.seconds;
    ratios.push_back(rate / course.course_rate);
  }
  fit.seconds = line.count();
  if (fit.seconds == 0) return fit;
  fit.slope = line.slope();
  fit.correlation = line.correlation();
  fit.median_ratio = median(ratios);
  return fit;
}

ConventionFinding check_yaw_rate_scale(const YawRateFit& fit, double imu_interval_s) {
  const double size = std::abs(fit.slope);
  if (!fit.follows() || is_right(fit.slope) || is_right(fit.median_ratio)) return {};
  if (size > 0.7 * kDegreesPerRadian && size < 1.4 * kDegreesPerRadian)
    return {Convention::kGyrosInDegrees, fit.slope};
  if (std::abs(size - imu_interval_s) < 0.2 * imu_interval_s)
    return {Convention::kIncrementsTimesInterval, fit.slope};
  return {Convention::kGyroUnit, fit.slope};
}

ConventionFinding check_yaw_rate_axis(const MotionRecord& record,
                                      const YawRateFit& about_vertical) {
  const bool turned = about_vertical.turned >= kMuchTurned;
  if (!turned || !(std::abs(about_vertical.slope) < kHardlyTurn)) return {};
  for (int axis = 0; axis < 3; ++axis) {
    const YawRateFit fit = fit_yaw_rate(record, Eigen::Vector3d::Unit(axis));
    const double size = std::abs(fit.slope);
    if (fit.follows() && size > kLeastTurn && size < kMostTurn)
      return {Convention::kGyroAxes, axis + 1.0};
  }
  return {};
}

ConventionFinding check_yaw_rate_delay(const MotionRecord& record, const MeanForce& force) {
  const Eigen::Vector3d down_b = -force.mean_b.normalized();
  if (!fit_yaw_rate(record, down_b).contradicts()) return {};
  YawRateFit best;
  int best_lag_s = 0;
  // The search begins with the shortest lag, because a repeating route fits at several.
  for (int step = 1; step <= 2 * kLongestLag_s; ++step) {
    const int lag_s = step % 2 == 1 ? -(step + 1) / 2 : step / 2;
    const YawRateFit fit = fit_yaw_rate(record, down_b, lag_s);
    const double size = std::abs(fit.slope);
    if (!fit.follows() || fit.turned < kMuchTurned || size < kLeastTurn || size > kMostTurn)
      continue;
    if (fit.correlation < best.correlation + kClearlyBetter) continue;
    best = fit;
    best_lag_s = lag_s;
  }
  return std::abs(best_lag_s) >= 2 ? stamp_finding(best_lag_s) : ConventionFinding();
}

}  // namespace leonav
