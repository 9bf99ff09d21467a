#include "drivers/rinex/navigation_record_4.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/base/calendar.h"
#include "core/gnss/orbits/satellite_state.h"
#include "drivers/binary/cnav_biases.h"
#include "drivers/rinex/calendar_fields.h"
#include "drivers/rinex/navigation_fields.h"
#include "drivers/rinex/navigation_record.h"
#include "drivers/rinex/satellite_refusal.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

constexpr NavigationLayout kLayout3;  // of the lines behind the first one
constexpr std::string_view kMissing = "record with missing lines";
constexpr std::string_view kDamagedNumber = "record with a damaged number";
constexpr std::string_view kDamagedTime = "record with a damaged time";

// A message whose elements are as in CNAV, of so many lines without the first one.
struct CnavForm {
  std::string_view name;
  System system;
  std::size_t lines;
  std::size_t transmission;  // field of the time of week at which it was sent
};
constexpr std::array<CnavForm, 4> kCnavForms = {{{"CNAV", System::kGps, 9, 31},
                                                 {"CNV2", System::kGps, 10, 35},
                                                 {"CNV1", System::kBeidou, 10, 35},
                                                 {"CNV2", System::kBeidou, 10, 35}}};
// Fields of all forms of BeiDou, of those of GPS, and of CNV1.
enum CnavField : std::size_t {
  kDeltaNRate = kKeplerFieldCount,
  kGpsTgd = 25,
  kIscL1Ca = 27,
  kIscL2c = 28,
  kIscL5I = 29,
  kIscL5Q = 30,
  kIscB1cData = 27,
  kIscB2aData = 28,
  kTgdB1cPilot = 29,
  kTgdB2aPilot = 30,
  kBeidouHealth = 32,
  kIodc = 34,
  kIode = 38,
};
using CnavFields = std::array<double, field_count(10)>;

std::optional<double> delay(double field) {
  return std::isfinite(field) ? std::optional(field) : std::nullopt;
}

// The elements of B-CNAV1, which serve corrections.
std::string_view take_bcnav1_elements(const CnavFields& f, const CnavForm& form,
                                      SatelliteId satellite, GpsTime toc_as_written,
                                      NavigationRecord4* record) {
  if (!has_elements(f) || !std::isfinite(f[kToe]) || !std::isfinite(f[kIode])) {
    return "record without one of its elements";
  }
  if (!(f[kToe] >= 0.0 && f[kToe] <= double{kSecondsPerWeek})) return kDamagedTime;
  Ephemeris e;
  e.satellite = satellite;
  e.message = NavigationMessage::kBeidouCnav1;
  copy_elements(f, &e);
  e.a_dot = or_zero(f[kIssueOrAxisRate]);
  e.delta_n_dot = or_zero(f[kDeltaNRate]);
  set_times(f[kToe], f[form.transmission], toc_as_written, -kBeidouMinusGpsSeconds, &e);
  if (!to_uint16(f[kIode], &e.issue) || !to_uint16(f[kIodc], &e.issue_clock) ||
      !to_uint16(f[kBeidouHealth], &e.health)) {
    return kDamagedNumber;
  }
  if (!is_sane(e)) return "record that no satellite can have sent";
  record->ephemeris = e;
  return {};
}

std::string_view take_cnav(std::span<const std::string> lines, const CnavForm& form,
                           SatelliteId satellite, NavigationRecord4* record) {
  if (lines.size() < form.lines) return kMissing;
  const auto toc = record_time(lines[0], false);
  if (!toc) return kDamagedTime;
  CnavFields f;
  const std::span used = std::span(f).first(field_count(form.lines));
  read_fields(lines.first(form.lines), false, used);
  if (std::find(used.begin(), used.end(), kDamagedField) != used.end()) return kDamagedNumber;
  const bool is_gps = form.system == System::kGps;
  const double to_gps_s = is_gps ? 0.0 : -kBeidouMinusGpsSeconds;
  const GpsTime time = toc->plus_seconds(to_gps_s);
  GpsTime sent = transmission_near(f[form.transmission] + to_gps_s, time);
  if (!sent.is_set()) sent = time;
  if (is_gps) {
    append_biases(GpsCnavDelays{delay(f[kGpsTgd]), delay(f[kIscL1Ca]), delay(f[kIscL2c]),
                                delay(f[kIscL5I]), delay(f[kIscL5Q])},
                  satellite, sent, &record->delays);
    return "CNAV record (group delays used, elements not used)";
  }
  append_biases(BeidouCnavDelays{delay(f[kTgdB1cPilot]), delay(f[kIscB1cData]),
                                 delay(f[kTgdB2aPilot]), delay(f[kIscB2aData])},
                satellite, sent, &record->delays);
  if (form.name == "CNV1") return take_bcnav1_elements(f, form, satellite, *toc, record);
  return "B-CNAV2 record (group delays used, elements not used)";
}

std::string_view take_kepler(const std::vector<std::string>& lines, NavigationMessage message,
                             NavigationRecord4* record) {
  Ephemeris ephemeris;
  const std::string_view reason = parse_navigation_record(lines, kLayout3, &ephemeris);
  if (!reason.empty()) return reason;
  ephemeris.message = message;
  record->ephemeris = ephemeris;
  return {};
}

// Returns the message in Kepler form of this name, or nullopt.
std::optional<NavigationMessage> kepler_message(System system, std::string_view name) {
  if (system == System::kGps && name == "LNAV") return NavigationMessage::kGpsLnav;
  if (system == System::kGalileo && name == "INAV") return NavigationMessage::kGalileoInav;
  if (system == System::kGalileo && name == "FNAV") return NavigationMessage::kGalileoFnav;
  if (system == System::kBeidou && name == "D1") return NavigationMessage::kBeidouD1;
  if (system == System::kBeidou && name == "D2") return NavigationMessage::kBeidouD2;
  return std::nullopt;
}

std::string_view take_ephemeris(const std::vector<std::string>& lines, std::string_view satellite,
                                std::string_view message, NavigationRecord4* record) {
  const auto id = satellite_from_string(satellite);
  if (!id) return satellite_refusal(satellite);
  const std::vector<std::string> body(lines.begin() + 1, lines.end());
  if (body.empty()) return kMissing;
  if (columns(body[0], 0, 3) != satellite) return "record with the lines of another satellite";
  if (const auto kepler = kepler_message(id->system, message)) {
    return take_kepler(body, *kepler, record);
  }
  for (const CnavForm& form : kCnavForms) {
    if (form.system != id->system || form.name != message) continue;
    const auto is_filled = [](const std::string& line) { return !is_blank(line); };
    const std::span surplus = std::span(body).subspan(std::min(form.lines, body.size()));
    if (std::any_of(surplus.begin(), surplus.end(), is_filled)) return "record with too many lines";
    return take_cnav(body, form, *id, record);
  }
  return "record of another navigation message (not used)";
}

// Three coefficients stand behind the time, then four, then one.
std::string_view take_klobuchar(std::span<const std::string> lines, NavigationRecord4* record) {
  constexpr std::size_t kLines = 3, kCoefficients = 8;
  if (lines.size() < kLines) return kMissing;
  std::array<double, field_count(kLines)> f;
  read_fields(lines.first(kLines), false, f);
  for (std::size_t i = 0; i < kCoefficients; ++i) {
    if (!std::isfinite(f[i])) return kDamagedNumber;
  }
  KlobucharModel model;
  std::copy_n(f.begin(), 4, model.alpha.begin());
  std::copy_n(f.begin() + 4, 4, model.beta.begin());
  model.valid = true;
  record->klobuchar = model;
  return {};
}

}  // namespace

bool starts_record_4(std::string_view line, std::size_t lines_before) {
  if (line.starts_with('>')) return true;
  return lines_before != 1 && starts_navigation_record(line, kLayout3);
}

std::string_view parse_record_4(const std::vector<std::string>& lines, NavigationRecord4* record) {
  const std::string_view head = lines[0];
  if (!head.starts_with('>')) return "record without its first line";
  const std::string_view kind = trim(columns(head, 2, 3)), satellite = columns(head, 6, 3),
                         message = trim(columns(head, 10, 4));
  if (kind == "EPH") return take_ephemeris(lines, satellite, message, record);
  if (kind == "STO") return "record of a time offset (not used)";
  if (kind == "EOP") return "record of the Earth's orientation (not used)";
  if (kind != "ION") return "record of a kind that is not known";
  const bool used = satellite.starts_with('G') && message == "LNAV";
  if (!used) return "record of an ionosphere model other than GPS LNAV's (not used)";
  return take_klobuchar(std::span(lines).subspan(1), record);
}

}  // namespace leonav
