#include "tools/export/utc_text.h"

#include "core/base/calendar.h"
#include "tools/common/format.h"

namespace leonav {

std::int64_t unix_nanoseconds(GpsTime time) {
  constexpr std::int64_t kUnixOfGpsEpoch_s = 315'964'800;  // 1980-01-06
  return time.nanoseconds() + (kUnixOfGpsEpoch_s - leap_seconds(time)) * kNanosecondsPerSecond;
}

std::string utc_text(GpsTime time) {
  constexpr std::int64_t kMillisecond = 1'000'000;
  const GpsTime rounded = GpsTime::from_nanoseconds((time.nanoseconds() + kMillisecond / 2) /
                                                    kMillisecond * kMillisecond);
  const CalendarTime utc =
      to_calendar(rounded.plus_nanoseconds(-leap_seconds(rounded) * kNanosecondsPerSecond));
  return format("%04d-%02d-%02dT%02d:%02d:%06.3fZ", utc.year, utc.month, utc.day, utc.hour,
                utc.minute, utc.second);
}

}  // namespace leonav
