#include "drivers/sbf/decoded_navigation.h"

#include <cmath>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "drivers/binary/accuracy_index.h"
#include "drivers/binary/beidou_time.h"
#include "drivers/binary/field_reader.h"
#include "drivers/sbf/sbf_signal.h"

namespace leonav {
namespace {

constexpr double kUnknownField = -2e10;  // "do not use", of real fields
constexpr int kGpsWeekModulus = 1024;

bool is_known(double value) { return std::isfinite(value) && value > kUnknownField / 2; }

bool set_satellite(System system, std::uint8_t number, Ephemeris* e) {
  const std::optional<SatelliteId> satellite = satellite_from_sbf(number);
  if (!satellite || satellite->system != system || !is_valid(*satellite)) return false;
  e->satellite = *satellite;
  return true;
}

// GPSNav and BDSNav have these fields in common, from the reference time of the clock on. Reference
// times are given as seconds of the system's week.
struct Elements {
  Elements(FieldReader* f, Ephemeris* e) : toc_s(f->number()) {
    e->af2 = f->single();
    e->af1 = f->single();
    e->af0 = f->single();
    e->crs = f->single();
    e->delta_n = f->single() * kPi;
    e->m0 = f->real() * kPi;
    e->cuc = f->single();
    e->eccentricity = f->real();
    e->cus = f->single();
    e->sqrt_a = f->real();
    toe_s = f->number();
    e->cic = f->single();
    e->omega0 = f->real() * kPi;
    e->cis = f->single();
    e->i0 = f->real() * kPi;
    e->crc = f->single();
    e->omega = f->real() * kPi;
    e->omega_dot = f->single() * kPi;
    e->i_dot = f->single() * kPi;
  }
  std::uint32_t toc_s = 0, toe_s = 0;
};

bool is_in_week(std::uint32_t seconds) { return seconds < kSecondsPerWeek; }

}  // namespace

EphemerisStatus read_gpsnav(std::span<const std::uint8_t> payload, GpsTime near,
                            Ephemeris* ephemeris) {
  constexpr std::size_t kSize = 126;
  if (payload.size() < kSize) return EphemerisStatus::kBadLength;
  Ephemeris& e = *ephemeris;
  e = {};
  FieldReader f(payload);
  if (!set_satellite(System::kGps, f.byte(), &e)) return EphemerisStatus::kBadSatellite;
  e.message = NavigationMessage::kGpsLnav;
  e.transmission_time = near;
  f.skip(1);
  const std::uint16_t week = f.half();
  f.skip(1);  // code on L2
  e.accuracy_m = nominal_accuracy_m(f.byte());
  e.health = f.byte();
  f.skip(1);  // P data on L2
  e.issue_clock = f.half();
  const std::uint8_t issue2 = f.byte(), issue3 = f.byte();
  f.skip(2);  // fit interval, reserved
  e.group_delay_s[0] = f.single();
  const Elements elements(&f, &e);
  e.issue = issue2;
  if (!is_in_week(elements.toe_s) || !is_in_week(elements.toc_s)) return EphemerisStatus::kBadTime;
  e.toe = nearest_instant(elements.toe_s, near);
  e.toc = nearest_instant(elements.toc_s, near);
  if (!week_agrees(week, kGpsWeekModulus, 0, near)) return EphemerisStatus::kBadWeek;
  if (issue2 != issue3 || (e.issue_clock & 0xFF) != issue2) return EphemerisStatus::kBadSubframes;
  return is_known(e.group_delay_s[0]) ? EphemerisStatus::kOk : EphemerisStatus::kNotSane;
}

EphemerisStatus read_bdsnav(std::span<const std::uint8_t> payload, GpsTime near,
                            Ephemeris* ephemeris) {
  constexpr std::size_t kSize = 126;
  constexpr std::uint16_t kLastWithB2i = 18;
  if (payload.size() < kSize) return EphemerisStatus::kBadLength;
  Ephemeris& e = *ephemeris;
  e = {};
  FieldReader f(payload);
  if (!set_satellite(System::kBeidou, f.byte(), &e)) return EphemerisStatus::kBadSatellite;
  e.message = is_beidou_geostationary(e.satellite) ? NavigationMessage::kBeidouD2
                                                   : NavigationMessage::kBeidouD1;
  e.transmission_time = near;
  f.skip(1);
  const std::uint16_t week = f.half();
  e.accuracy_m = nominal_accuracy_m(f.byte());
  e.health = f.byte();
  e.issue_clock = f.byte();
  e.issue = f.byte();
  f.skip(2);
  e.group_delay_s[0] = f.single();
  e.group_delay_s[1] = f.single();
  const Elements elements(&f, &e);
  if (!is_in_week(elements.toe_s) || !is_in_week(elements.toc_s)) return EphemerisStatus::kBadTime;
  e.toe = nearest_beidou_instant(elements.toe_s, near);
  e.toc = nearest_beidou_instant(elements.toc_s, near);
  if (week >= kBeidouWeekModulus || !beidou_week_agrees(week, near)) {
    return EphemerisStatus::kBadWeek;
  }
  if (!is_known(e.group_delay_s[1]) && e.satellite.number > kLastWithB2i) e.group_delay_s[1] = 0.0;
  const bool has_delays = is_known(e.group_delay_s[0]) && is_known(e.group_delay_s[1]);
  return has_delays ? EphemerisStatus::kOk : EphemerisStatus::kNotSane;
}

EphemerisStatus read_galnav(std::span<const std::uint8_t> payload, GpsTime near,
                            Ephemeris* ephemeris) {
  constexpr std::size_t kSize = 130;
  constexpr std::uint8_t kInav = 2, kFnav = 16;
  if (payload.size() < kSize) return EphemerisStatus::kBadLength;
  Ephemeris& e = *ephemeris;
  e = {};
  FieldReader f(payload);
  if (!set_satellite(System::kGalileo, f.byte(), &e)) return EphemerisStatus::kBadSatellite;
  e.transmission_time = near;
  const std::uint8_t source = f.byte();
  e.sqrt_a = f.real();
  e.m0 = f.real() * kPi;
  e.eccentricity = f.real();
  e.i0 = f.real() * kPi;
  e.omega = f.real() * kPi;
  e.omega0 = f.real() * kPi;
  e.omega_dot = f.single() * kPi;
  e.i_dot = f.single() * kPi;
  e.delta_n = f.single() * kPi;
  e.cuc = f.single();
  e.cus = f.single();
  e.crc = f.single();
  e.crs = f.single();
  e.cic = f.single();
  e.cis = f.single();
  const std::uint32_t toe_s = f.number(), toc_s = f.number();
  e.af2 = f.single();
  e.af1 = f.single();
  e.af0 = f.real();
  const std::uint16_t toe_week = f.half(), toc_week = f.half();
  e.issue = f.half();
  // Four bits of each signal, E1-B, E5b, E5a: whether the others are valid, data validity, health.
  const std::uint16_t health = f.half();
  const auto bits_of = [health](int signal) {
    const unsigned four = (static_cast<unsigned>(health) >> (4 * signal)) & 0xFu;
    return (four & 1u) != 0 ? four >> 1 : 0u;
  };
  f.skip(1);  // health of the restricted service
  const std::uint8_t accuracy_e5a = f.byte(), accuracy_e5b = f.byte();
  f.skip(1);  // accuracy of the restricted service
  e.group_delay_s[0] = f.single();
  e.group_delay_s[1] = f.single();
  if (source != kInav && source != kFnav) return EphemerisStatus::kNotSane;
  const bool is_inav = source == kInav;
  e.message = is_inav ? NavigationMessage::kGalileoInav : NavigationMessage::kGalileoFnav;
  // The bits are packed as in RINEX: E1-B in bits 0-2, E5a in bits 3-5, E5b in bits 6-8.
  e.health = static_cast<std::uint16_t>(is_inav ? bits_of(0) | (bits_of(1) << 6) : bits_of(2) << 3);
  e.accuracy_m = galileo_sisa_m(is_inav ? accuracy_e5b : accuracy_e5a);
  if (!is_in_week(toe_s) || !is_in_week(toc_s)) return EphemerisStatus::kBadTime;
  e.toe = nearest_instant(toe_s, near);
  e.toc = nearest_instant(toc_s, near);
  if (!week_agrees(toe_week, kGalileoWeekModulus, 0, e.toe) ||
      !week_agrees(toc_week, kGalileoWeekModulus, 0, e.toc)) {
    return EphemerisStatus::kBadWeek;
  }
  // F/NAV has no delay of E5b.
  const bool has_delays =
      is_known(e.group_delay_s[0]) && (!is_inav || is_known(e.group_delay_s[1]));
  if (!is_inav) e.group_delay_s[1] = 0.0;
  return has_delays ? EphemerisStatus::kOk : EphemerisStatus::kNotSane;
}

std::optional<KlobucharModel> read_gpsion(std::span<const std::uint8_t> payload) {
  constexpr std::size_t kSize = 2 + 8 * 4;
  if (payload.size() < kSize) return std::nullopt;
  FieldReader f(payload);
  f.skip(2);  // satellite, signal
  KlobucharModel model;
  bool is_whole = true;
  const auto take = [&](double* coefficient) {
    *coefficient = f.single();
    is_whole = is_whole && is_known(*coefficient);
  };
  for (double& alpha : model.alpha) take(&alpha);
  for (double& beta : model.beta) take(&beta);
  if (!is_whole) return std::nullopt;
  model.valid = true;
  return model;
}

}  // namespace leonav
