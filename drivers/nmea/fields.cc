#include "drivers/nmea/fields.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "core/base/angle.h"
#include "core/base/calendar.h"

namespace leonav {
namespace {

template <typename... Values>
std::string print(const char* format, Values... values) {
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

PlaceFields place_fields(double radians, int digits, const char* positive, const char* negative) {
  if (!std::isfinite(radians)) return {};
  constexpr std::int64_t kPerMinute = 1'000'000, kPerDegree = 60 * kPerMinute;
  const std::int64_t steps =
      std::llround(std::abs(radians) * kDegreesPerRadian * static_cast<double>(kPerDegree));
  const auto degrees = static_cast<long long>(steps / kPerDegree);
  const auto minutes = static_cast<long long>(steps % kPerDegree / kPerMinute);
  const auto fraction = static_cast<long long>(steps % kPerMinute);
  return {print("%0*lld%02lld.%06lld", digits, degrees, minutes, fraction),
          radians < 0.0 && steps > 0 ? negative : positive};
}

}  // namespace

UtcFields utc_fields(GpsTime time) {
  constexpr std::int64_t kStep_ns = 1'000'000;
  const std::int64_t whole = time.nanoseconds() / kStep_ns;
  const std::int64_t up = time.nanoseconds() % kStep_ns >= kStep_ns / 2 ? 1 : 0;
  const GpsTime rounded = GpsTime::from_nanoseconds((whole + up) * kStep_ns);
  const int ahead = leap_seconds(rounded);
  // The count grows where the new day begins; the second before that is the inserted one, and has
  // the date of the day that it ends.
  const GpsTime later = rounded.plus_nanoseconds(kNanosecondsPerSecond);
  const bool is_inserted = leap_seconds(later) > ahead;
  const int back = ahead + (is_inserted ? 1 : 0);
  const CalendarTime utc = to_calendar(rounded.plus_nanoseconds(-back * kNanosecondsPerSecond));
  const int milliseconds =
      static_cast<int>(std::lround(utc.second * 1000.0)) + (is_inserted ? 1000 : 0);
  // Two decimals, as most receivers write them, wherever they say it all.
  const int second = milliseconds / 1000, fraction = milliseconds % 1000;
  const std::string decimals =
      fraction % 10 == 0 ? print("%02d", fraction / 10) : print("%03d", fraction);
  return {print("%02d%02d%02d.", utc.hour, utc.minute, second) + decimals, print("%02d", utc.day),
          print("%02d", utc.month), print("%04d", utc.year)};
}

std::string number_field(double value, int decimals) {
  if (!std::isfinite(value)) return "";
  const std::string text = print("%.*f", decimals, value);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

std::string bearing_field(double radians) {
  if (!std::isfinite(radians)) return "";
  const double degrees = std::fmod(radians * kDegreesPerRadian, 360.0);
  const auto steps = static_cast<int>((std::lround(degrees * 100.0) + 36'000) % 36'000);
  return print("%d.%02d", steps / 100, steps % 100);
}

PlaceFields latitude_fields(double radians) { return place_fields(radians, 2, "N", "S"); }
PlaceFields longitude_fields(double radians) { return place_fields(radians, 3, "E", "W"); }

}  // namespace leonav
