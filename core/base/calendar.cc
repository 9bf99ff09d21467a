#include "core/base/calendar.h"

#include <array>
#include <cmath>

namespace leonav {
namespace {

constexpr std::int64_t kSecondsPerDay = 86'400;
constexpr std::int64_t kDaysPerEra = 146'097;  // 400 Gregorian years

// Returns the days since 1980-01-06. They are counted in eras of 400 years whose years begin in
// March, so that the leap day is the last of its year (Richards, Explanatory Supplement to the
// Astronomical Almanac, 15.11, has the same idea in other variables).
std::int64_t days_from_civil(std::int64_t year, std::int64_t month, std::int64_t day) {
  // Months outside 1-12 carry into the year, as seconds carry into minutes.
  const std::int64_t months = year * 12 + month - 1 - 2;  // from March of year 0
  const std::int64_t march_year = (months >= 0 ? months : months - 11) / 12;
  const std::int64_t march_month = months - march_year * 12;
  const std::int64_t era = (march_year >= 0 ? march_year : march_year - 399) / 400;
  const std::int64_t year_of_era = march_year - era * 400;
  const std::int64_t day_of_year = (153 * march_month + 2) / 5 + day - 1;
  const std::int64_t day_of_era =
      year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
  constexpr std::int64_t kGpsEpochFromMarch0000 = 723'125;  // 1980-01-06
  return era * kDaysPerEra + day_of_era - kGpsEpochFromMarch0000;
}

CalendarTime civil_from_days(std::int64_t days) {
  days += 723'125;
  const std::int64_t era = (days >= 0 ? days : days - kDaysPerEra + 1) / kDaysPerEra;
  const std::int64_t day_of_era = days - era * kDaysPerEra;
  const std::int64_t year_of_era =
      (day_of_era - day_of_era / 1460 + day_of_era / 36'524 - day_of_era / 146'096) / 365;
  const std::int64_t day_of_year =
      day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const std::int64_t march_month = (5 * day_of_year + 2) / 153;
  CalendarTime calendar;
  calendar.day = static_cast<int>(day_of_year - (153 * march_month + 2) / 5 + 1);
  calendar.month = static_cast<int>(march_month < 10 ? march_month + 3 : march_month - 9);
  calendar.year = static_cast<int>(year_of_era + era * 400 + (calendar.month <= 2 ? 1 : 0));
  return calendar;
}

struct LeapSecond {
  int year, month, day;
};
// Each entry is the first day after a leap second since 1980. Source: IERS Bulletin C (1 to 70).
constexpr std::array<LeapSecond, 18> kLeapSeconds{{{1981, 7, 1},
                                                   {1982, 7, 1},
                                                   {1983, 7, 1},
                                                   {1985, 7, 1},
                                                   {1988, 1, 1},
                                                   {1990, 1, 1},
                                                   {1991, 1, 1},
                                                   {1992, 7, 1},
                                                   {1993, 7, 1},
                                                   {1994, 7, 1},
                                                   {1996, 1, 1},
                                                   {1997, 7, 1},
                                                   {1999, 1, 1},
                                                   {2006, 1, 1},
                                                   {2009, 1, 1},
                                                   {2012, 7, 1},
                                                   {2015, 7, 1},
                                                   {2017, 1, 1}}};

}  // namespace

GpsTime from_calendar(const CalendarTime& calendar) {
  const std::int64_t minutes =
      (days_from_civil(calendar.year, calendar.month, calendar.day) * 24 + calendar.hour) * 60 +
      calendar.minute;
  constexpr std::int64_t kMaxMinutes = 150'000'000;  // 285 years, as in GpsTime
  if (minutes > kMaxMinutes || minutes < -kMaxMinutes) return {};
  return GpsTime::from_nanoseconds(minutes * 60 * kNanosecondsPerSecond)
      .plus_seconds(calendar.second);
}

CalendarTime to_calendar(GpsTime time) {
  constexpr std::int64_t kNanosecondsPerDay = kSecondsPerDay * kNanosecondsPerSecond;
  const std::int64_t ns = time.nanoseconds();
  const std::int64_t days = (ns >= 0 ? ns : ns - kNanosecondsPerDay + 1) / kNanosecondsPerDay;
  const std::int64_t in_day = ns - days * kNanosecondsPerDay;
  const std::int64_t minutes = in_day / (60 * kNanosecondsPerSecond);
  CalendarTime calendar = civil_from_days(days);
  calendar.hour = static_cast<int>(minutes / 60);
  calendar.minute = static_cast<int>(minutes % 60);
  calendar.second = static_cast<double>(in_day - minutes * 60 * kNanosecondsPerSecond) / 1e9;
  return calendar;
}

int leap_seconds(GpsTime time) {
  int count = 0;
  for (const LeapSecond& leap : kLeapSeconds) {
    const std::int64_t start_utc =
        days_from_civil(leap.year, leap.month, leap.day) * kSecondsPerDay * kNanosecondsPerSecond;
    // In GPS time the new day begins later by the seconds inserted so far, including this one.
    if (time.nanoseconds() < start_utc + (count + 1) * kNanosecondsPerSecond) break;
    ++count;
  }
  return count;
}

// The second look-up is right on the day of a leap second too.
GpsTime gps_from_utc(GpsTime reading) {
  const GpsTime first = reading.plus_seconds(leap_seconds(reading));
  return reading.plus_seconds(leap_seconds(first));
}

}  // namespace leonav
