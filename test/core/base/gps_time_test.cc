#include "core/base/gps_time.h"

#include <limits>

#include "core/base/calendar.h"
#include "support/catch.h"

using namespace leonav;

TEST_CASE("GpsTime keeps every nanosecond of a week and time of week", "[time]") {
  const GpsTime t = GpsTime::from_week_and_tow(2381, 408640.961);
  CHECK(t.nanoseconds() == 2381 * kNanosecondsPerWeek + 408'640'961'000'000);
  CHECK(t.week() == 2381);
  CHECK(t.tow_s() == 408640.961);
  CHECK(GpsTime::from_week_and_tow(2381, 604799.999999999).nanoseconds() ==
        2382 * kNanosecondsPerWeek - 1);
  // Times of week outside the week carry, in both directions.
  CHECK(GpsTime::from_week_and_tow(2381, 604800.0) == GpsTime::from_week_and_tow(2382, 0.0));
  CHECK(GpsTime::from_week_and_tow(2381, -0.25) == GpsTime::from_week_and_tow(2380, 604799.75));
}

TEST_CASE("GpsTime sums and differences are exact", "[time]") {
  const GpsTime t = GpsTime::from_week_and_tow(2400, 0.1);
  CHECK(t.plus_seconds(0.005).nanoseconds() - t.nanoseconds() == 5'000'000);
  CHECK(t.plus_seconds(-0.3).nanoseconds() - t.nanoseconds() == -300'000'000);
  CHECK(seconds_between(t.plus_nanoseconds(1), t) == 1e-9);
  CHECK(seconds_between(t, t.plus_seconds(1e5)) == -1e5);
}

TEST_CASE("An instant that no double can mean is unset", "[time]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 1e300, -1e300, 1e10}) {
    CHECK_FALSE(GpsTime::from_week_and_tow(2381, bad).is_set());
    CHECK_FALSE(GpsTime::from_week_and_tow(2381, 0.0).plus_seconds(bad).is_set());
  }
  CHECK_FALSE(GpsTime::from_week_and_tow(std::numeric_limits<int>::max(), 0.0).is_set());
  CHECK_FALSE(GpsTime::from_week_and_tow(std::numeric_limits<int>::min(), 0.0).is_set());
}

// Published: GPS week roll-overs on 1999-08-22 (1024) and 2019-04-07 (2048); the BeiDou epoch is
// 2006-01-01 (BDS-SIS-ICD), Galileo's 1999-08-22.
TEST_CASE("Calendar agrees with published epochs", "[time]") {
  CHECK(from_calendar({1980, 1, 6, 0, 0, 0.0}).nanoseconds() == 0);
  CHECK(from_calendar({1999, 8, 22, 0, 0, 0.0}) == GpsTime::from_week_and_tow(1024, 0.0));
  CHECK(from_calendar({2019, 4, 7, 0, 0, 0.0}) == GpsTime::from_week_and_tow(2048, 0.0));
  CHECK(from_calendar({2006, 1, 1, 0, 0, 0.0}) ==
        GpsTime::from_week_and_tow(kBeidouWeekZeroInGpsWeeks, 0.0));
  // The day of the drive set: 2021-04-28 is day of year 118, a Wednesday.
  CHECK(from_calendar({2021, 4, 28, 22, 15, 10.0}) == GpsTime::from_week_and_tow(2155, 339310.0));
}

TEST_CASE("Calendar goes there and back for every day of 1980 to 2120", "[time]") {
  int wrong = 0;
  CalendarTime previous = to_calendar(GpsTime::from_nanoseconds(0));
  for (std::int64_t day = 1; day < 140 * 365; ++day) {
    const GpsTime t = GpsTime::from_nanoseconds(day * 86'400 * kNanosecondsPerSecond + 1);
    const CalendarTime c = to_calendar(t);
    if (from_calendar(c) != t) ++wrong;
    const bool next_day = c.day == previous.day + 1 && c.month == previous.month;
    const bool next_month = c.day == 1 && c.month == previous.month + 1 && previous.day >= 28;
    const bool next_year = c.day == 1 && c.month == 1 && previous.month == 12;
    if (!next_day && !next_month && !next_year) ++wrong;
    previous = c;
  }
  CHECK(wrong == 0);
  const CalendarTime c = to_calendar(from_calendar({2024, 2, 29, 23, 59, 59.999999999}));
  CHECK(c.day == 29);
  CHECK(c.minute == 59);
  CHECK(c.second == 59.999999999);
  CHECK(from_calendar({2100, 2, 29, 0, 0, 0.0}) == from_calendar({2100, 3, 1, 0, 0, 0.0}));
}

TEST_CASE("Calendar fields carry", "[time]") {
  CHECK(from_calendar({2023, 12, 31, 23, 59, 60.0}) == from_calendar({2024, 1, 1, 0, 0, 0.0}));
  CHECK(from_calendar({2023, 13, 1, 0, 0, 0.0}) == from_calendar({2024, 1, 1, 0, 0, 0.0}));
  CHECK_FALSE(from_calendar({2'000'000'000, 1, 1, 0, 0, 0.0}).is_set());
}

// IERS Bulletin C: UTC-GPS differences at the ends of the list and around the last leap second.
TEST_CASE("Leap seconds", "[time]") {
  CHECK(leap_seconds(GpsTime::from_nanoseconds(1)) == 0);
  CHECK(leap_seconds(from_calendar({1981, 7, 1, 0, 0, 0.9})) == 0);
  CHECK(leap_seconds(from_calendar({1981, 7, 1, 0, 0, 1.0})) == 1);
  CHECK(leap_seconds(from_calendar({1999, 8, 22, 0, 0, 0.0})) == 13);
  CHECK(leap_seconds(from_calendar({2006, 1, 2, 0, 0, 0.0})) == 14);
  CHECK(leap_seconds(from_calendar({2017, 1, 1, 0, 0, 17.999})) == 17);
  CHECK(leap_seconds(from_calendar({2017, 1, 1, 0, 0, 18.0})) == 18);
  CHECK(leap_seconds(from_calendar({2026, 1, 1, 0, 0, 0.0})) == 18);
}

TEST_CASE("GPS time of UTC around a leap second", "[time]") {
  const auto at = [](const CalendarTime& utc) { return gps_from_utc(from_calendar(utc)); };
  const GpsTime midnight = from_calendar({2017, 1, 1, 0, 0, 0.0});
  CHECK(at({2016, 12, 31, 23, 59, 59.5}) == midnight.plus_seconds(16.5));
  CHECK(at({2016, 12, 31, 23, 59, 60.5}) == midnight.plus_seconds(17.5));
  CHECK(at({2017, 1, 1, 0, 0, 1.0}) == midnight.plus_seconds(19.0));
  CHECK(at({1980, 1, 6, 0, 0, 1.0}) == GpsTime::from_nanoseconds(kNanosecondsPerSecond));
  CHECK(at({2026, 1, 1, 0, 0, 0.0}) == from_calendar({2026, 1, 1, 0, 0, 18.0}));
}
