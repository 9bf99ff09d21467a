#include "drivers/rinex/navigation_fields.h"

#include <cmath>

#include "drivers/rinex/calendar_fields.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr std::size_t kNavigationWidth = 19;

// Returns the instant with this time of week that is nearest to `reference`.
GpsTime nearest_with_tow(double tow_s, GpsTime reference) {
  const GpsTime guess = GpsTime::from_week_and_tow(reference.week(), tow_s);
  const double weeks = std::round(seconds_between(reference, guess) / double{kSecondsPerWeek});
  return guess.plus_nanoseconds(static_cast<std::int64_t>(weeks) * kNanosecondsPerWeek);
}

double field_value(std::string_view field) {
  if (is_blank(field)) return std::numeric_limits<double>::quiet_NaN();
  // A number that is cut off by the end of the line is still a number, but not the one sent.
  const auto value = field.size() == kNavigationWidth ? parse_double(field) : std::nullopt;
  return value ? *value : kDamagedField;
}

}  // namespace

void read_fields(std::span<const std::string> lines, bool version_2, std::span<double> fields) {
  const std::size_t first_start = version_2 ? 22 : 23;
  const std::size_t next_start = version_2 ? 3 : 4;
  std::size_t index = 0;
  for (std::size_t line = 0; line < lines.size(); ++line) {
    const std::size_t count = line == 0 ? 3 : 4;
    for (std::size_t i = 0; i < count; ++i, ++index) {
      const std::size_t start = (line == 0 ? first_start : next_start) + i * kNavigationWidth;
      fields[index] = field_value(columns(lines[line], start, kNavigationWidth));
    }
  }
}

std::optional<GpsTime> record_time(std::string_view line, bool version_2) {
  if (!version_2) {
    return time_fields(parse_int(columns(line, 4, 4)), columns(line, 9, 2), columns(line, 12, 2),
                       columns(line, 15, 2), columns(line, 18, 2), columns(line, 21, 2));
  }
  const auto year = parse_int(columns(line, 3, 2));
  if (!year) return std::nullopt;
  return time_fields(complete_year(*year), columns(line, 6, 2), columns(line, 9, 2),
                     columns(line, 12, 2), columns(line, 15, 2), columns(line, 17, 5));
}

bool has_elements(std::span<const double> fields) {
  for (const KeplerField field : {kAf0, kSqrtA, kEccentricity, kM0, kOmega0, kI0, kOmega}) {
    if (!std::isfinite(fields[field])) return false;
  }
  return true;
}

double or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

bool to_uint16(double value, std::uint16_t* result) {
  const double number = std::round(or_zero(value));
  if (number < 0.0 || number > 65535.0) return false;
  *result = static_cast<std::uint16_t>(number);
  return true;
}

void copy_elements(std::span<const double> f, Ephemeris* e) {
  e->af0 = f[kAf0], e->af1 = or_zero(f[kAf1]), e->af2 = or_zero(f[kAf2]);
  e->sqrt_a = f[kSqrtA], e->eccentricity = f[kEccentricity], e->m0 = f[kM0];
  e->delta_n = or_zero(f[kDeltaN]);
  e->omega0 = f[kOmega0], e->omega_dot = or_zero(f[kOmegaDot]);
  e->i0 = f[kI0], e->i_dot = or_zero(f[kIDot]), e->omega = f[kOmega];
  e->cuc = or_zero(f[kCuc]), e->cus = or_zero(f[kCus]);
  e->crc = or_zero(f[kCrc]), e->crs = or_zero(f[kCrs]);
  e->cic = or_zero(f[kCic]), e->cis = or_zero(f[kCis]);
}

GpsTime transmission_near(double tow_s, GpsTime reference) {
  constexpr double kPlausibleAge_s = 86'400.0;  // unknown is written as 0, 9.999e8 or blank
  if (!(std::abs(tow_s) <= 2.0 * double{kSecondsPerWeek})) return {};
  const GpsTime sent = nearest_with_tow(tow_s, reference);
  return std::abs(seconds_between(sent, reference)) <= kPlausibleAge_s ? sent : GpsTime{};
}

void set_times(double toe_tow_s, double transmission_tow_s, GpsTime toc_as_written, double to_gps_s,
               Ephemeris* e) {
  e->toc = toc_as_written.plus_seconds(to_gps_s);
  e->toe = nearest_with_tow(toe_tow_s + to_gps_s, e->toc);
  e->transmission_time = transmission_near(transmission_tow_s + to_gps_s, e->toe);
}

}  // namespace leonav
