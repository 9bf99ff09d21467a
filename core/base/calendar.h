// This unit converts between GPS time, the Gregorian calendar, UTC and the weeks of other systems.
#pragma once
#include "core/base/gps_time.h"

namespace leonav {

// A date and time of day.
struct CalendarTime {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0;
  double second = 0.0;
};

// The calendar is the proleptic Gregorian one and its hours are GPS time (no leap seconds). Fields
// of `calendar` may lie outside their usual range and carry over (month 13 is the next January).
// The instant is unset where it lies beyond 285 years from the GPS epoch.
GpsTime from_calendar(const CalendarTime& calendar);
CalendarTime to_calendar(GpsTime time);

// Returns how many seconds GPS time is ahead of UTC at `time` (18 since 2017-01-01). Source: IERS
// Bulletin C.
int leap_seconds(GpsTime time);

// Returns the GPS time of an instant whose UTC from_calendar() has turned into `reading`. An
// inserted second, 23:59:60, and the one behind it have the same reading, which is taken for the
// former.
GpsTime gps_from_utc(GpsTime reading);

// A week beyond this one, of the year 2137, is no receiver's: newer messages have 13 bits for it.
inline constexpr int kLastGpsWeek = 8191;
// BeiDou time is GPS time minus 14 s (BDS-SIS-ICD 3.3); its week 0 is GPS week 1356.
inline constexpr int kBeidouMinusGpsSeconds = -14;
inline constexpr int kBeidouWeekZeroInGpsWeeks = 1356;
// Galileo system time equals GPS time up to nanoseconds; its week 0 is GPS week 1024.
inline constexpr int kGalileoWeekZeroInGpsWeeks = 1024;
inline constexpr int kGalileoWeekModulus = 4096;

}  // namespace leonav
