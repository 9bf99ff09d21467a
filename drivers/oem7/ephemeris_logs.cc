#include "drivers/oem7/ephemeris_logs.h"

#include <algorithm>
#include <cmath>

#include "core/gnss/orbits/satellite_state.h"
#include "drivers/binary/accuracy_index.h"
#include "drivers/binary/beidou_time.h"
#include "drivers/binary/field_reader.h"
#include "drivers/binary/gps_lnav_data.h"
#include "drivers/binary/week_time.h"

namespace leonav {
namespace {

bool set_satellite(System system, std::uint32_t number, Ephemeris* e) {
  if (number > kHighestNumber[index_of(system)]) return false;
  e->satellite = {system, static_cast<std::uint16_t>(number)};
  return is_valid(e->satellite);
}

std::uint16_t to_u2(std::uint32_t value) {
  return static_cast<std::uint16_t>(std::min<std::uint32_t>(value, 0xFFFF));
}

// Returns whether a full week is that of `time`, or the week beside it.
bool is_week_of(std::uint32_t week, GpsTime time) {
  const std::int64_t difference = std::int64_t{week} - time.week();
  return difference >= -1 && difference <= 1;
}

EphemerisStatus sane(const Ephemeris& e) {
  return is_sane(e) ? EphemerisStatus::kOk : EphemerisStatus::kNotSane;
}

// The bits are packed as in RINEX: E1-B in bits 0-2, E5a in bits 3-5, E5b in bits 6-8.
std::uint16_t fnav_health(unsigned e5a_invalid, unsigned e5a_health) {
  return static_cast<std::uint16_t>((e5a_invalid << 3) | (e5a_health << 4));
}

std::uint16_t inav_health(unsigned e1b_invalid, unsigned e1b_health, unsigned e5b_invalid,
                          unsigned e5b_health) {
  return static_cast<std::uint16_t>(e1b_invalid | (e1b_health << 1) | (e5b_invalid << 6) |
                                    (e5b_health << 7));
}

// Takes what GALINAVEPHEMERIS and GALFNAVEPHEMERIS hold in the same order: behind the health and
// before the delay between E1 and E5b.
void take_galileo_set(FieldReader* f, GpsTime near, Ephemeris* e) {
  e->transmission_time = near;
  e->issue = f->half();
  e->accuracy_m = galileo_sisa_m(f->byte());
  f->skip(1);  // of I/NAV the signals that the set came from
  e->toe = nearest_instant_of(f->number(), near);
  e->toc = nearest_instant_of(f->number(), near);
  for (double* field : {&e->m0, &e->delta_n, &e->eccentricity, &e->sqrt_a, &e->i0, &e->i_dot,
                        &e->omega0, &e->omega, &e->omega_dot, &e->cuc, &e->cus, &e->crc, &e->crs,
                        &e->cic, &e->cis, &e->af0, &e->af1, &e->af2, &e->group_delay_s[0]}) {
    *field = f->real();
  }
}

GpsLnavBits subframe_at(std::span<const std::uint8_t> payload, std::size_t offset) {
  GpsLnavBits bits{};
  std::copy_n(payload.begin() + static_cast<std::ptrdiff_t>(offset), bits.size(), bits.begin());
  return bits;
}

}  // namespace

EphemerisStatus read_rawephem(std::span<const std::uint8_t> payload, GpsTime near,
                              Ephemeris* ephemeris) {
  constexpr std::size_t kSize = 12 + 3 * 30;
  if (payload.size() < kSize) return EphemerisStatus::kBadLength;
  if (!set_satellite(System::kGps, read_u4(payload.data()), ephemeris)) {
    return EphemerisStatus::kBadSatellite;
  }
  std::array<GpsLnavBits, 3> subframes;
  GpsTime sent;
  for (std::uint32_t i = 0; i < subframes.size(); ++i) {
    subframes[i] = subframe_at(payload, 12 + 30 * i);
    const std::optional<GpsLnavHead> head = read_gps_lnav_head(subframes[i]);
    if (!head || head->number != i + 1) return EphemerisStatus::kBadSubframes;
    sent = std::max(sent, nearest_instant(head->sent_tow_s, near));
  }
  const auto& [first, second, third] = subframes;
  if (!gps_lnav_issues_agree(first, second, third)) return EphemerisStatus::kBadSubframes;
  if (!gps_lnav_week_agrees(first, sent)) return EphemerisStatus::kBadWeek;
  *ephemeris = decode_gps_lnav(ephemeris->satellite, sent, first, second, third);
  return sane(*ephemeris);
}

EphemerisStatus read_gpsephem(std::span<const std::uint8_t> payload, GpsTime near,
                              Ephemeris* ephemeris) {
  constexpr std::size_t kSize = 224;
  if (payload.size() < kSize) return EphemerisStatus::kBadLength;
  Ephemeris& e = *ephemeris;
  e = {};
  FieldReader f(payload);
  if (!set_satellite(System::kGps, f.number(), &e)) return EphemerisStatus::kBadSatellite;
  e.message = NavigationMessage::kGpsLnav;
  e.transmission_time = nearest_instant_of(f.real(), near);
  e.health = to_u2(f.number());
  const std::uint32_t issue2 = f.number(), issue3 = f.number();
  const std::uint32_t week = f.number();
  f.skip(4);  // the week of the time of transmission
  e.toe = nearest_instant_of(f.real(), near);
  e.sqrt_a = std::sqrt(f.real());
  e.delta_n = f.real();
  e.m0 = f.real();
  e.eccentricity = f.real();
  e.omega = f.real();
  e.cuc = f.real();
  e.cus = f.real();
  e.crc = f.real();
  e.crs = f.real();
  e.cic = f.real();
  e.cis = f.real();
  e.i0 = f.real();
  e.i_dot = f.real();
  e.omega0 = f.real();
  e.omega_dot = f.real();
  const std::uint32_t issue_clock = f.number();
  e.toc = nearest_instant_of(f.real(), near);
  e.group_delay_s[0] = f.real();
  e.af0 = f.real();
  e.af1 = f.real();
  e.af2 = f.real();
  f.skip(4 + 8);  // anti-spoofing, corrected mean motion
  e.accuracy_m = std::sqrt(f.real());
  e.issue = to_u2(issue2);
  e.issue_clock = to_u2(issue_clock);
  if (!e.toe.is_set() || !e.toc.is_set() || !e.transmission_time.is_set()) {
    return EphemerisStatus::kBadTime;
  }
  if (!is_week_of(week, e.toe)) return EphemerisStatus::kBadWeek;
  if (issue2 != issue3 || (issue_clock & 0xFF) != issue2) return EphemerisStatus::kBadSubframes;
  if (!std::isfinite(e.accuracy_m)) return EphemerisStatus::kNotSane;
  return sane(e);
}

EphemerisStatus read_bdsephemeris(std::span<const std::uint8_t> payload, GpsTime near,
                                  Ephemeris* ephemeris) {
  constexpr std::size_t kSize = 196;
  if (payload.size() < kSize) return EphemerisStatus::kBadLength;
  Ephemeris& e = *ephemeris;
  e = {};
  FieldReader f(payload);
  if (!set_satellite(System::kBeidou, f.number(), &e)) return EphemerisStatus::kBadSatellite;
  e.message = is_beidou_geostationary(e.satellite) ? NavigationMessage::kBeidouD2
                                                   : NavigationMessage::kBeidouD1;
  e.transmission_time = near;
  const std::uint32_t week = f.number();
  e.accuracy_m = f.real();
  e.health = to_u2(f.number());
  e.group_delay_s[0] = f.real();
  e.group_delay_s[1] = f.real();
  e.issue_clock = to_u2(f.number());
  const std::uint32_t toc_s = f.number();
  e.af0 = f.real();
  e.af1 = f.real();
  e.af2 = f.real();
  e.issue = to_u2(f.number());
  const std::uint32_t toe_s = f.number();
  e.sqrt_a = f.real();
  e.eccentricity = f.real();
  e.omega = f.real();
  e.delta_n = f.real();
  e.m0 = f.real();
  e.omega0 = f.real();
  e.omega_dot = f.real();
  e.i0 = f.real();
  e.i_dot = f.real();
  e.cuc = f.real();
  e.cus = f.real();
  e.crc = f.real();
  e.crs = f.real();
  e.cic = f.real();
  e.cis = f.real();
  if (toe_s >= kSecondsPerWeek || toc_s >= kSecondsPerWeek) return EphemerisStatus::kBadTime;
  e.toe = nearest_beidou_instant(toe_s, near);
  e.toc = nearest_beidou_instant(toc_s, near);
  if (week >= kBeidouWeekModulus || !beidou_week_agrees(static_cast<int>(week), e.toe)) {
    return EphemerisStatus::kBadWeek;
  }
  if (!std::isfinite(e.accuracy_m)) return EphemerisStatus::kNotSane;
  return sane(e);
}

EphemerisStatus read_galinavephemeris(std::span<const std::uint8_t> payload, GpsTime near,
                                      Ephemeris* ephemeris) {
  constexpr std::size_t kSize = 184;
  if (payload.size() != kSize) return EphemerisStatus::kBadLength;
  Ephemeris& e = *ephemeris;
  e = {};
  FieldReader f(payload);
  if (!set_satellite(System::kGalileo, f.number(), &e)) return EphemerisStatus::kBadSatellite;
  e.message = NavigationMessage::kGalileoInav;
  const unsigned e5b_health = f.byte() & 3u, e5b_invalid = f.byte() & 1u;
  f.skip(2);
  const unsigned e1b_health = f.byte() & 3u, e1b_invalid = f.byte() & 1u;
  f.skip(2);
  e.health = inav_health(e1b_invalid, e1b_health, e5b_invalid, e5b_health);
  take_galileo_set(&f, near, &e);
  e.group_delay_s[1] = f.real();
  if (!e.toe.is_set() || !e.toc.is_set()) return EphemerisStatus::kBadTime;
  return sane(e);
}

EphemerisStatus read_galfnavephemeris(std::span<const std::uint8_t> payload, GpsTime near,
                                      Ephemeris* ephemeris) {
  constexpr std::size_t kSize = 172;
  if (payload.size() != kSize) return EphemerisStatus::kBadLength;
  Ephemeris& e = *ephemeris;
  e = {};
  FieldReader f(payload);
  if (!set_satellite(System::kGalileo, f.number(), &e)) return EphemerisStatus::kBadSatellite;
  e.message = NavigationMessage::kGalileoFnav;
  const unsigned e5a_health = f.byte() & 3u, e5a_invalid = f.byte() & 1u;
  f.skip(2);
  e.health = fnav_health(e5a_invalid, e5a_health);
  take_galileo_set(&f, near, &e);
  if (!e.toe.is_set() || !e.toc.is_set()) return EphemerisStatus::kBadTime;
  return sane(e);
}

EphemerisStatus read_galephemeris(std::span<const std::uint8_t> payload, GpsTime near,
                                  GalileoSets* sets) {
  constexpr std::size_t kSize = 220;
  if (payload.size() < kSize) return EphemerisStatus::kBadLength;
  Ephemeris e;
  FieldReader f(payload);
  if (!set_satellite(System::kGalileo, f.number(), &e)) return EphemerisStatus::kBadSatellite;
  e.transmission_time = near;
  const bool has_fnav = f.number() != 0, has_inav = f.number() != 0;
  const unsigned e1b_health = f.byte() & 3u, e5a_health = f.byte() & 3u, e5b_health = f.byte() & 3u;
  const unsigned e1b_invalid = f.byte() & 1u, e5a_invalid = f.byte() & 1u;
  const unsigned e5b_invalid = f.byte() & 1u;
  e.accuracy_m = galileo_sisa_m(f.byte());
  f.skip(1);
  e.issue = to_u2(f.number());
  e.toe = nearest_instant_of(f.number(), near);
  e.sqrt_a = f.real();
  e.delta_n = f.real();
  e.m0 = f.real();
  e.eccentricity = f.real();
  e.omega = f.real();
  e.cuc = f.real();
  e.cus = f.real();
  e.crc = f.real();
  e.crs = f.real();
  e.cic = f.real();
  e.cis = f.real();
  e.i0 = f.real();
  e.i_dot = f.real();
  e.omega0 = f.real();
  e.omega_dot = f.real();
  const auto read_clock = [&f, near](Ephemeris* set) {
    set->toc = nearest_instant_of(f.number(), near);
    set->af0 = f.real();
    set->af1 = f.real();
    set->af2 = f.real();
  };
  Ephemeris fnav = e, inav = e;
  read_clock(&fnav);
  read_clock(&inav);
  fnav.message = NavigationMessage::kGalileoFnav;
  fnav.health = fnav_health(e5a_invalid, e5a_health);
  inav.message = NavigationMessage::kGalileoInav;
  inav.health = inav_health(e1b_invalid, e1b_health, e5b_invalid, e5b_health);
  fnav.group_delay_s[0] = inav.group_delay_s[0] = f.real();
  inav.group_delay_s[1] = f.real();
  if (!e.toe.is_set()) return EphemerisStatus::kBadTime;
  for (const auto& [has, set, target] :
       {std::tuple{has_inav, &inav, &sets->inav}, std::tuple{has_fnav, &fnav, &sets->fnav}}) {
    if (!has) continue;
    if (!set->toc.is_set()) return EphemerisStatus::kBadTime;
    if (!is_sane(*set)) return EphemerisStatus::kNotSane;
    *target = *set;
  }
  return EphemerisStatus::kOk;
}

std::optional<KlobucharModel> read_ionutc(std::span<const std::uint8_t> payload) {
  constexpr std::size_t kCoefficients = 8;
  if (payload.size() < kCoefficients * sizeof(double)) return std::nullopt;
  FieldReader f(payload);
  KlobucharModel model;
  for (double& alpha : model.alpha) alpha = f.real();
  for (double& beta : model.beta) beta = f.real();
  const auto is_finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(model.alpha.begin(), model.alpha.end(), is_finite) ||
      !std::all_of(model.beta.begin(), model.beta.end(), is_finite)) {
    return std::nullopt;
  }
  model.valid = true;
  return model;
}

}  // namespace leonav
