#include "drivers/rinex/navigation_record.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/calendar.h"
#include "core/gnss/orbits/satellite_state.h"
#include "drivers/rinex/calendar_fields.h"
#include "drivers/rinex/satellite_refusal.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr std::size_t kLines = 8;  // of a record in Kepler form
constexpr std::size_t kFieldWidth = 19;

// Fields in the order of RINEX 3.05 tables A6 (GPS), A8 (Galileo), A14 (BeiDou); 2.11 table A4.
enum Field : std::size_t {
  kAf0,
  kAf1,
  kAf2,  //
  kIssue,
  kCrs,
  kDeltaN,
  kM0,  //
  kCuc,
  kEccentricity,
  kCus,
  kSqrtA,  //
  kToe,
  kCic,
  kOmega0,
  kCis,  //
  kI0,
  kCrc,
  kOmega,
  kOmegaDot,  //
  kIDot,
  kDataSources,
  kWeek,
  kSpare5,  //
  kAccuracy,
  kHealth,
  kGroupDelay1,
  kGroupDelay2OrIodc,  //
  kTransmission,
  kFitOrAodc,
  kSpare7a,
  kSpare7b,
  kFieldCount
};
// NaN: the field is blank.
using Fields = std::array<double, kFieldCount>;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Returns false if a field is neither blank nor a complete number.
bool read_fields(const std::vector<std::string>& lines, const NavigationLayout& layout,
                 Fields* fields) {
  const std::size_t first_start = layout.is_version_2 ? 22 : 23;
  const std::size_t next_start = layout.is_version_2 ? 3 : 4;
  std::size_t index = 0;
  for (std::size_t line = 0; line < kLines; ++line) {
    const std::size_t count = line == 0 ? 3 : 4;
    for (std::size_t i = 0; i < count; ++i, ++index) {
      const std::size_t start = (line == 0 ? first_start : next_start) + i * kFieldWidth;
      const std::string_view field = columns(lines[line], start, kFieldWidth);
      (*fields)[index] = std::numeric_limits<double>::quiet_NaN();
      if (is_blank(field)) continue;
      // A number that is cut off by the end of the line is still a number, but not the one sent.
      const auto value = field.size() == kFieldWidth ? parse_double(field) : std::nullopt;
      if (!value) {
        if (index >= kSpare7a || index == kSpare5) continue;
        return false;
      }
      (*fields)[index] = *value;
    }
  }
  return true;
}

std::optional<GpsTime> epoch_field(std::string_view line, bool version_2) {
  if (!version_2) {
    return time_fields(parse_int(columns(line, 4, 4)), columns(line, 9, 2), columns(line, 12, 2),
                       columns(line, 15, 2), columns(line, 18, 2), columns(line, 21, 2));
  }
  const auto year = parse_int(columns(line, 3, 2));
  if (!year) return std::nullopt;
  return time_fields(complete_year(*year), columns(line, 6, 2), columns(line, 9, 2),
                     columns(line, 12, 2), columns(line, 15, 2), columns(line, 17, 5));
}

double or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

// Returns the instant with this time of week that is nearest to `reference`.
GpsTime nearest_with_tow(double tow_s, GpsTime reference) {
  const GpsTime guess = GpsTime::from_week_and_tow(reference.week(), tow_s);
  const double weeks = std::round(seconds_between(reference, guess) / double{kSecondsPerWeek});
  return guess.plus_nanoseconds(static_cast<std::int64_t>(weeks) * kNanosecondsPerWeek);
}

bool to_uint16(double value, std::uint16_t* result) {
  const double number = std::round(or_zero(value));
  if (number < 0.0 || number > 65535.0) return false;
  *result = static_cast<std::uint16_t>(number);
  return true;
}

void copy_elements(const Fields& f, Ephemeris* e) {
  e->af0 = f[kAf0], e->af1 = or_zero(f[kAf1]), e->af2 = or_zero(f[kAf2]);
  e->sqrt_a = f[kSqrtA], e->eccentricity = f[kEccentricity], e->m0 = f[kM0];
  e->delta_n = or_zero(f[kDeltaN]);
  e->omega0 = f[kOmega0], e->omega_dot = or_zero(f[kOmegaDot]);
  e->i0 = f[kI0], e->i_dot = or_zero(f[kIDot]), e->omega = f[kOmega];
  e->cuc = or_zero(f[kCuc]), e->cus = or_zero(f[kCus]);
  e->crc = or_zero(f[kCrc]), e->crs = or_zero(f[kCrs]);
  e->cic = or_zero(f[kCic]), e->cis = or_zero(f[kCis]);
  e->accuracy_m = or_zero(f[kAccuracy]);
}

// Times of week are the system's own. The week is the one nearest to the clock's reference time,
// because the week field is written modulo 1024, of toe or of the transmission, depending on the
// program that wrote the file.
void set_times(const Fields& f, GpsTime toc_as_written, double to_gps_s, Ephemeris* e) {
  e->toc = toc_as_written.plus_seconds(to_gps_s);
  e->toe = nearest_with_tow(f[kToe] + to_gps_s, e->toc);
  e->transmission_time = {};
  constexpr double kPlausibleAge = 86'400.0;  // unknown is written as 0, 9.999e8 or blank
  if (!(std::abs(f[kTransmission]) <= 2.0 * double{kSecondsPerWeek})) return;
  const GpsTime sent = nearest_with_tow(f[kTransmission] + to_gps_s, e->toe);
  if (std::abs(seconds_between(sent, e->toe)) <= kPlausibleAge) e->transmission_time = sent;
}

// RINEX 3.05 table A8: bits 0 and 2 mean I/NAV, bit 1 F/NAV. Where both are set the clock is the
// one for E5a (bit 8, F/NAV) or for E5b (bit 9, I/NAV).
NavigationMessage galileo_message(double data_sources) {
  std::uint16_t bits = 0;
  if (!to_uint16(data_sources, &bits)) return NavigationMessage::kGalileoInav;
  const bool inav = (bits & 0b101U) != 0, fnav = (bits & 0b010U) != 0;
  const bool clock_e5a = (bits & 0x100U) != 0, clock_e5b = (bits & 0x200U) != 0;
  const bool is_fnav = (fnav && !inav) || (fnav == inav && clock_e5a && !clock_e5b);
  return is_fnav ? NavigationMessage::kGalileoFnav : NavigationMessage::kGalileoInav;
}

// Reads the fields whose position depends on the system. Returns false if a number is out of range.
bool set_system_fields(const Fields& f, Ephemeris* e) {
  e->group_delay_s = {or_zero(f[kGroupDelay1]), 0.0};
  bool ok = to_uint16(f[kIssue], &e->issue) && to_uint16(f[kHealth], &e->health);
  switch (e->satellite.system) {
    case System::kGps:
      e->message = NavigationMessage::kGpsLnav;
      return ok && to_uint16(f[kGroupDelay2OrIodc], &e->issue_clock);
    case System::kGalileo:
      e->message = galileo_message(f[kDataSources]);
      e->group_delay_s[1] = or_zero(f[kGroupDelay2OrIodc]);
      return ok;
    case System::kBeidou:
      e->message = is_beidou_geostationary(e->satellite) ? NavigationMessage::kBeidouD2
                                                         : NavigationMessage::kBeidouD1;
      e->group_delay_s[1] = or_zero(f[kGroupDelay2OrIodc]);
      return ok && to_uint16(f[kFitOrAodc], &e->issue_clock);
    case System::kLeo:
      return false;
  }
  return false;
}

}  // namespace

bool starts_navigation_record(std::string_view line, const NavigationLayout& layout) {
  if (line.size() < 3) return false;
  if (layout.is_version_2) return is_digit(line[1]) && (line[0] == ' ' || is_digit(line[0]));
  return line[0] >= 'A' && line[0] <= 'Z' && is_digit(line[2]) &&
         (line[1] == ' ' || is_digit(line[1]));
}

std::string record_satellite(std::string_view line, const NavigationLayout& layout) {
  if (!layout.is_version_2) return std::string(columns(line, 0, 3));
  return layout.system + std::string(columns(line, 0, 2));
}

std::string_view parse_navigation_record(const std::vector<std::string>& lines,
                                         const NavigationLayout& layout, Ephemeris* ephemeris) {
  const auto satellite = satellite_from_string(record_satellite(lines[0], layout));
  if (!satellite) return "satellite name that is not readable";
  if (satellite->system == System::kLeo) return "LEO record (no broadcast message is defined)";
  if (lines.size() < kLines) return "record with missing lines";
  for (std::size_t i = kLines; i < lines.size(); ++i) {
    if (!is_blank(lines[i])) return "record with too many lines";
  }
  const auto toc = epoch_field(lines[0], layout.is_version_2);
  if (!toc) return "record with a damaged time";
  Fields fields;
  if (!read_fields(lines, layout, &fields)) return "record with a damaged number";
  for (const Field field : {kAf0, kSqrtA, kEccentricity, kM0, kOmega0, kI0, kOmega, kToe}) {
    if (!std::isfinite(fields[field])) return "record without one of its elements";
  }
  if (!(fields[kToe] >= 0.0 && fields[kToe] <= double{kSecondsPerWeek})) {
    return "record with a damaged time";
  }
  Ephemeris result;
  result.satellite = *satellite;
  copy_elements(fields, &result);
  const bool is_beidou = satellite->system == System::kBeidou;
  set_times(fields, *toc, is_beidou ? -kBeidouMinusGpsSeconds : 0.0, &result);
  if (!set_system_fields(fields, &result)) return "record with a damaged number";
  if (!is_sane(result)) return "record that no satellite can have sent";
  *ephemeris = result;
  return {};
}

}  // namespace leonav
