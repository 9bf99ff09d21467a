#include "tools/common/day.h"

#include "core/base/calendar.h"
#include "drivers/text/parse.h"

namespace leonav {

std::optional<GpsTime> noon_of(const std::string& text) {
  constexpr std::size_t kYear = 4, kMonth = 7, kLength = 10;
  if (text.size() != kLength || text[kYear] != '-' || text[kMonth] != '-') return std::nullopt;
  const auto year = parse_int(text.substr(0, 4)), month = parse_int(text.substr(5, 2)),
             day = parse_int(text.substr(8, 2));
  if (!year || !month || !day || *year < 1980 || *year > 2099) return std::nullopt;
  const GpsTime noon = from_calendar({*year, *month, *day, 12, 0, 0.0});
  const CalendarTime back = to_calendar(noon);
  if (back.year != *year || back.month != *month || back.day != *day) return std::nullopt;
  return noon;
}

std::optional<GpsTime> instant_of(const std::string& text) {
  constexpr std::size_t kTime = 10, kMinute = 13, kSecond = 16;
  const auto noon = text.size() > kMinute ? noon_of(text.substr(0, kTime)) : std::nullopt;
  if (!noon || (text[kTime] != 'T' && text[kTime] != ' ') || text[kMinute] != ':')
    return std::nullopt;
  const auto hour = parse_int(text.substr(kTime + 1, 2)),
             minute = parse_int(text.substr(kMinute + 1, 2));
  std::optional<double> second = 0.0;
  if (text.size() > kSecond)
    second = text[kSecond] == ':' ? parse_double(text.substr(kSecond + 1)) : std::nullopt;
  if (!hour || !minute || !second || *hour < 0 || *hour > 23 || *minute < 0 || *minute > 59 ||
      !(*second >= 0.0 && *second < 60.0))
    return std::nullopt;
  return noon->plus_seconds((*hour - 12) * 3600.0 + *minute * 60.0 + *second);
}

}  // namespace leonav
