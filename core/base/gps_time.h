// This header represents GPS time as an integer count of nanoseconds: no rounding, a total order,
// no leap seconds.
#pragma once
#include <compare>
#include <cstdint>

namespace leonav {

inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
inline constexpr std::int64_t kSecondsPerWeek = 604'800;
inline constexpr std::int64_t kNanosecondsPerWeek = kSecondsPerWeek * kNanosecondsPerSecond;

// One instant, as nanoseconds since 1980-01-06 00:00:00 GPS time. The zero instant means "unset".
class GpsTime {
 public:
  constexpr GpsTime() = default;
  static constexpr GpsTime from_nanoseconds(std::int64_t nanoseconds) {
    return GpsTime(nanoseconds);
  }
  // Builds an instant from the week number without roll-over and the time of week in seconds, which
  // may lie outside [0, 604800). It is rounded to the nearest nanosecond, and unset where it lies
  // beyond 285 years or an argument is not finite.
  static GpsTime from_week_and_tow(int week, double tow_s);

  constexpr std::int64_t nanoseconds() const { return nanoseconds_; }
  constexpr bool is_set() const { return nanoseconds_ != 0; }
  constexpr int week() const { return static_cast<int>(nanoseconds_ / kNanosecondsPerWeek); }
  double tow_s() const;

  constexpr GpsTime plus_nanoseconds(std::int64_t nanoseconds) const {
    return GpsTime(nanoseconds_ + nanoseconds);
  }
  // The result is rounded to the nearest nanosecond, and unset beyond 285 years.
  GpsTime plus_seconds(double seconds) const;

  friend constexpr auto operator<=>(GpsTime, GpsTime) = default;

 private:
  explicit constexpr GpsTime(std::int64_t nanoseconds) : nanoseconds_(nanoseconds) {}
  std::int64_t nanoseconds_ = 0;
};

// Returns a - b in seconds: an exact difference, rounded once to double.
double seconds_between(GpsTime a, GpsTime b);

// a - b in nanoseconds, exact.
constexpr std::int64_t nanoseconds_between(GpsTime a, GpsTime b) {
  return a.nanoseconds() - b.nanoseconds();
}

}  // namespace leonav
