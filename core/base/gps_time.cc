#include "core/base/gps_time.h"

#include <cmath>

namespace leonav {
namespace {

// An instant farther than this from the GPS epoch (285 years) is an input error, and nanoseconds
// could overflow.
constexpr double kMaxSeconds = 9.0e9;

// Whole seconds and the fraction are converted separately, so that no digit of the fraction is lost
// in the product.
std::int64_t to_nanoseconds(double seconds) {
  const double whole = std::floor(seconds);
  const double fraction = seconds - whole;
  return static_cast<std::int64_t>(whole) * kNanosecondsPerSecond +
         static_cast<std::int64_t>(std::llround(fraction * 1e9));
}

bool usable(double seconds) { return std::abs(seconds) <= kMaxSeconds; }  // false for NaN

}  // namespace

GpsTime GpsTime::from_week_and_tow(int week, double tow_s) {
  const double total = static_cast<double>(week) * static_cast<double>(kSecondsPerWeek);
  if (!usable(tow_s) || !usable(total) || !usable(total + tow_s)) return {};
  return GpsTime(week * kNanosecondsPerWeek + to_nanoseconds(tow_s));
}

double GpsTime::tow_s() const {
  const std::int64_t in_week = nanoseconds_ - week() * kNanosecondsPerWeek;
  const std::int64_t whole = in_week / kNanosecondsPerSecond;
  return static_cast<double>(whole) +
         static_cast<double>(in_week - whole * kNanosecondsPerSecond) * 1e-9;
}

GpsTime GpsTime::plus_seconds(double seconds) const {
  const double now = static_cast<double>(nanoseconds_) * 1e-9;
  if (!usable(seconds) || !usable(now + seconds)) return {};
  return GpsTime(nanoseconds_ + to_nanoseconds(seconds));
}

double seconds_between(GpsTime a, GpsTime b) {
  return static_cast<double>(a.nanoseconds() - b.nanoseconds()) / 1e9;
}

}  // namespace leonav
