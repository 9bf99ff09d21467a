#include "drivers/rinex/calendar_fields.h"

#include <array>

#include "core/base/calendar.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

int days_in_month(int year, int month) {
  constexpr std::array<int, 12> kDays = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
  return kDays[static_cast<std::size_t>(month - 1)] + (month == 2 && leap ? 1 : 0);
}

// Returns the seconds in nanoseconds, or nullopt unless the field has only digits and at most one
// point.
std::optional<std::int64_t> nanoseconds_of(std::string_view field) {
  const std::string_view text = trim(field);
  const std::size_t point = text.find('.');
  const std::string_view digits = text.substr(0, point);
  const auto whole = digits.empty() ? 0 : parse_int(digits);  // Fortran may leave out the zero
  if (!whole || *whole < 0 || *whole > 60 || digits.find('-') != digits.npos) return std::nullopt;
  std::int64_t nanoseconds = *whole * kNanosecondsPerSecond;
  if (point == std::string_view::npos) return nanoseconds;
  std::int64_t unit = kNanosecondsPerSecond / 10;
  for (const char c : text.substr(point + 1)) {
    if (!is_digit(c)) return std::nullopt;
    nanoseconds += (c - '0') * unit;
    unit /= 10;
  }
  return nanoseconds;
}

}  // namespace

bool is_blank(std::string_view text) { return trim(text).empty(); }

std::optional<GpsTime> time_fields(std::optional<int> year, std::string_view month,
                                   std::string_view day, std::string_view hour,
                                   std::string_view minute, std::string_view second) {
  const auto mo = parse_int(month), d = parse_int(day), h = parse_int(hour), mi = parse_int(minute);
  const auto ns = is_blank(second) ? std::nullopt : nanoseconds_of(second);
  if (!year || !mo || !d || !h || !mi || !ns) return std::nullopt;
  if (*year < 1980 || *year > 2099 || *mo < 1 || *mo > 12 || *d < 1 ||
      *d > days_in_month(*year, *mo) || *h < 0 || *h > 23 || *mi < 0 || *mi > 59) {
    return std::nullopt;
  }
  CalendarTime calendar;
  calendar.year = *year;
  calendar.month = *mo;
  calendar.day = *d;
  calendar.hour = *h;
  calendar.minute = *mi;
  return from_calendar(calendar).plus_nanoseconds(*ns);
}

int complete_year(int year) {
  if (year < 0 || year > 99) return year;
  return year >= 80 ? 1900 + year : 2000 + year;
}

}  // namespace leonav
