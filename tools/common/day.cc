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

}  // namespace leonav
