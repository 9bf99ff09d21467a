#include "tools/connect/stamps/host_clock.h"

#include <sys/timex.h>

#include <chrono>
#include <cmath>

#include "core/base/calendar.h"

namespace leonav {
namespace {

constexpr std::int64_t kGpsEpochSince1970_s = 315'964'800;

GpsTime gps_from_wall(std::int64_t wall_ns) {
  return gps_from_utc(
      GpsTime::from_nanoseconds(wall_ns - kGpsEpochSince1970_s * kNanosecondsPerSecond));
}

// The bound that stands for none: it grows by 500 ppm from the last setting on, up to this one.
constexpr long kNoBound_us = 16'000'000;

// Whether the wall clock shows the first minute of a half-year, before which leap seconds are.
bool leap_second_may_have_been(std::int64_t wall_ns) {
  namespace chrono = std::chrono;
  const chrono::sys_time<chrono::nanoseconds> time{chrono::nanoseconds(wall_ns)};
  const auto day = chrono::floor<chrono::days>(time);
  const chrono::year_month_day date(day);
  return time - day < chrono::minutes(1) && date.day() == chrono::day(1) &&
         (date.month() == chrono::January || date.month() == chrono::July);
}

}  // namespace

HostClock::HostClock(std::int64_t begin_ns)
    : gps_minus_arrival_ns_(gps_from_wall(begin_ns).nanoseconds() - begin_ns) {}

std::int64_t HostClock::wall_ns() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

// The flag STA_UNSYNC says less: chrony without 'rtcsync' leaves it set, so that the kernel does
// not write the time to the real-time clock.
bool HostClock::is_unsynchronised(int (*ask)(timex*)) {
  timex answer{};
  return ask(&answer) >= 0 && answer.maxerror >= kNoBound_us;
}

bool HostClock::is_unsynchronised() { return is_unsynchronised(::adjtimex); }

std::optional<double> HostClock::compare(std::int64_t wall_ns, std::int64_t arrival_ns) {
  const GpsTime by_wall = gps_from_wall(wall_ns).plus_seconds(leap_seconds_ahead_);
  const double difference_s = seconds_between(by_wall, at(arrival_ns));
  if (std::abs(difference_s) <= kTolerance_s) {
    comparisons_ = 0;
    return std::nullopt;
  }
  const bool is_same = std::abs(difference_s - difference_s_) <= kTolerance_s;
  comparisons_ = is_same ? comparisons_ + 1 : 1;
  difference_s_ = difference_s;
  if (comparisons_ < kComparisons) return std::nullopt;
  comparisons_ = 0;
  if (std::abs(std::abs(difference_s) - 1.0) <= kTolerance_s &&
      leap_second_may_have_been(wall_ns)) {
    leap_seconds_ahead_ += difference_s < 0.0 ? 1 : -1;
    return std::nullopt;
  }
  gps_minus_arrival_ns_ += std::llround(difference_s * 1e9);
  ++steps_;
  last_step_s_ = difference_s;
  return difference_s;
}

}  // namespace leonav
