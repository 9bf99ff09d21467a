#include "drivers/rinex/navigation_record.h"

#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "core/base/calendar.h"
#include "core/gnss/orbits/satellite_state.h"
#include "drivers/rinex/calendar_fields.h"
#include "drivers/rinex/navigation_fields.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr std::size_t kKeplerLines = 8;  // of a record in Kepler form

// Fields behind those that all messages share.
enum Field : std::size_t {
  kDataSources = kKeplerFieldCount,
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
static_assert(kFieldCount == field_count(kKeplerLines));
using Fields = std::array<double, kFieldCount>;

// Returns whether a field that is used is damaged.
bool has_damage(const Fields& fields) {
  for (std::size_t i = 0; i < kSpare7a; ++i) {
    if (i != kSpare5 && fields[i] == kDamagedField) return true;
  }
  return false;
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
  bool ok = to_uint16(f[kIssueOrAxisRate], &e->issue) && to_uint16(f[kHealth], &e->health);
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
  if (lines.size() < kKeplerLines) return "record with missing lines";
  for (std::size_t i = kKeplerLines; i < lines.size(); ++i) {
    if (!is_blank(lines[i])) return "record with too many lines";
  }
  const auto toc = record_time(lines[0], layout.is_version_2);
  if (!toc) return "record with a damaged time";
  Fields fields;
  read_fields(std::span(lines).first(kKeplerLines), layout.is_version_2, fields);
  if (has_damage(fields)) return "record with a damaged number";
  if (!has_elements(fields) || !std::isfinite(fields[kToe])) {
    return "record without one of its elements";
  }
  if (!(fields[kToe] >= 0.0 && fields[kToe] <= double{kSecondsPerWeek})) {
    return "record with a damaged time";
  }
  Ephemeris result;
  result.satellite = *satellite;
  copy_elements(fields, &result);
  result.accuracy_m = or_zero(fields[kAccuracy]);
  const bool is_beidou = satellite->system == System::kBeidou;
  set_times(fields[kToe], fields[kTransmission], *toc, is_beidou ? -kBeidouMinusGpsSeconds : 0.0,
            &result);
  if (!set_system_fields(fields, &result)) return "record with a damaged number";
  if (!is_sane(result)) return "record that no satellite can have sent";
  *ephemeris = result;
  return {};
}

}  // namespace leonav
