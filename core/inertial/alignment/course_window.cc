#include "core/inertial/alignment/course_window.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace leonav {

void CourseWindow::add(const Course& course) {
  // Courses of fast receivers are thinned out to the capacity of the window.
  if (!entries_.empty() &&
      course.time_s - entries_.back().time_s < length_s_ / static_cast<double>(kCapacity - 4)) {
    return;
  }
  if (entries_.size() == kCapacity) entries_.erase(entries_.begin());
  entries_.push_back(
      {course.time_s, course.course - course.relative_yaw, 1.0 / (course.sigma * course.sigma)});
  while (entries_.size() > kMinCourses &&
         entries_.back().time_s - entries_[1].time_s >= length_s_) {
    entries_.erase(entries_.begin());
  }
}

std::optional<CourseWindow::Agreement> CourseWindow::agreement() const {
  // Epochs lie on a grid up to rounding, so that three seconds of epochs count as three seconds.
  constexpr double kRounding_s = 1e-3;
  if (entries_.size() < kMinCourses ||
      entries_.back().time_s - entries_.front().time_s < length_s_ - kRounding_s) {
    return std::nullopt;
  }
  std::complex<double> sum;
  double weights = 0.0;
  for (const Entry& entry : entries_) {
    sum += std::polar(entry.weight, entry.difference);
    weights += entry.weight;
  }
  // Mean resultant length R: the circular variance is -2 ln R (Mardia and Jupp, Directional
  // Statistics, 2000, section 2.3).
  const double resultant = std::abs(sum) / weights;
  if (!(resultant > 1e-6)) return std::nullopt;
  const double spread_squared = std::max(0.0, -2.0 * std::log(resultant));
  const double mean_variance = static_cast<double>(entries_.size()) / weights;
  return Agreement{std::arg(sum), std::sqrt(spread_squared + mean_variance)};
}

}  // namespace leonav
