#include "drivers/rtcm3/broadcast_ephemeris.h"

#include <cstdlib>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "core/gnss/orbits/satellite_state.h"
#include "drivers/binary/accuracy_index.h"
#include "drivers/binary/beidou_time.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/week_time.h"

namespace leonav {
namespace {

constexpr std::uint16_t kGpsEphemeris = 1019, kBeidouEphemeris = 1042, kGalileoFnavEphemeris = 1045,
                        kGalileoInavEphemeris = 1046;
constexpr int kGpsWeekModulus = 1024;
constexpr double kBeidouGroupDelayUnit = 1e-10;  // s

// What a message says of its times, besides the elements.
struct Times {
  int week = 0;  // truncated, of the system's own count
  std::int64_t toe_s = 0, toc_s = 0;
};

Times take_gps(BitReader r, Ephemeris* e) {
  Times t;
  t.week = static_cast<int>(r.take(10));
  e->accuracy_m = nominal_accuracy_m(r.take(4));
  e->i_dot = r.skip(2).scaled_signed(14, -43) * kPi;  // behind the code on L2
  e->issue = static_cast<std::uint16_t>(r.take(8));
  t.toc_s = std::int64_t{r.take(16)} * 16;
  e->af2 = r.scaled_signed(8, -55);
  e->af1 = r.scaled_signed(16, -43);
  e->af0 = r.scaled_signed(22, -31);
  e->issue_clock = static_cast<std::uint16_t>(r.take(10));
  e->crs = r.scaled_signed(16, -5);
  e->delta_n = r.scaled_signed(16, -43) * kPi;
  e->m0 = r.scaled_signed(32, -31) * kPi;
  e->cuc = r.scaled_signed(16, -29);
  e->eccentricity = r.scaled(32, -33);
  e->cus = r.scaled_signed(16, -29);
  e->sqrt_a = r.scaled(32, -19);
  t.toe_s = std::int64_t{r.take(16)} * 16;
  e->cic = r.scaled_signed(16, -29);
  e->omega0 = r.scaled_signed(32, -31) * kPi;
  e->cis = r.scaled_signed(16, -29);
  e->i0 = r.scaled_signed(32, -31) * kPi;
  e->crc = r.scaled_signed(16, -5);
  e->omega = r.scaled_signed(32, -31) * kPi;
  e->omega_dot = r.scaled_signed(24, -43) * kPi;
  e->group_delay_s[0] = r.scaled_signed(8, -31);
  e->health = static_cast<std::uint16_t>(r.take(6));
  return t;
}

Times take_beidou(BitReader r, Ephemeris* e) {
  Times t;
  t.week = static_cast<int>(r.take(13));
  e->accuracy_m = nominal_accuracy_m(r.take(4));
  e->i_dot = r.scaled_signed(14, -43) * kPi;
  e->issue = static_cast<std::uint16_t>(r.take(5));
  t.toc_s = std::int64_t{r.take(17)} * 8;
  e->af2 = r.scaled_signed(11, -66);
  e->af1 = r.scaled_signed(22, -50);
  e->af0 = r.scaled_signed(24, -33);
  e->issue_clock = static_cast<std::uint16_t>(r.take(5));
  e->crs = r.scaled_signed(18, -6);
  e->delta_n = r.scaled_signed(16, -43) * kPi;
  e->m0 = r.scaled_signed(32, -31) * kPi;
  e->cuc = r.scaled_signed(18, -31);
  e->eccentricity = r.scaled(32, -33);
  e->cus = r.scaled_signed(18, -31);
  e->sqrt_a = r.scaled(32, -19);
  t.toe_s = std::int64_t{r.take(17)} * 8;
  e->cic = r.scaled_signed(18, -31);
  e->omega0 = r.scaled_signed(32, -31) * kPi;
  e->cis = r.scaled_signed(18, -31);
  e->i0 = r.scaled_signed(32, -31) * kPi;
  e->crc = r.scaled_signed(18, -6);
  e->omega = r.scaled_signed(32, -31) * kPi;
  e->omega_dot = r.scaled_signed(24, -43) * kPi;
  e->group_delay_s[0] = r.take_signed(10) * kBeidouGroupDelayUnit;
  e->group_delay_s[1] = r.take_signed(10) * kBeidouGroupDelayUnit;
  e->health = static_cast<std::uint16_t>(r.take(1));
  return t;
}

// Both messages begin alike; `r` is moved to what differs.
Times take_galileo(BitReader* r, Ephemeris* e) {
  Times t;
  t.week = static_cast<int>(r->take(12));
  e->issue = static_cast<std::uint16_t>(r->take(10));
  e->accuracy_m = galileo_sisa_m(r->take(8));
  e->i_dot = r->scaled_signed(14, -43) * kPi;
  t.toc_s = std::int64_t{r->take(14)} * 60;
  e->af2 = r->scaled_signed(6, -59);
  e->af1 = r->scaled_signed(21, -46);
  e->af0 = r->scaled_signed(31, -34);
  e->crs = r->scaled_signed(16, -5);
  e->delta_n = r->scaled_signed(16, -43) * kPi;
  e->m0 = r->scaled_signed(32, -31) * kPi;
  e->cuc = r->scaled_signed(16, -29);
  e->eccentricity = r->scaled(32, -33);
  e->cus = r->scaled_signed(16, -29);
  e->sqrt_a = r->scaled(32, -19);
  t.toe_s = std::int64_t{r->take(14)} * 60;
  e->cic = r->scaled_signed(16, -29);
  e->omega0 = r->scaled_signed(32, -31) * kPi;
  e->cis = r->scaled_signed(16, -29);
  e->i0 = r->scaled_signed(32, -31) * kPi;
  e->crc = r->scaled_signed(16, -5);
  e->omega = r->scaled_signed(32, -31) * kPi;
  e->omega_dot = r->scaled_signed(24, -43) * kPi;
  e->group_delay_s[0] = r->scaled_signed(10, -32);
  return t;
}

// Health bits are packed as in RINEX: E1-B in bits 0 to 2, E5a in 3 to 5, E5b in 6 to 8, the data
// validity below the health of each.
Times take_fnav(BitReader r, Ephemeris* e) {
  const Times t = take_galileo(&r, e);
  const std::uint32_t health = r.take(2), invalid = r.take(1);
  e->health = static_cast<std::uint16_t>((invalid << 3) | (health << 4));
  return t;
}

Times take_inav(BitReader r, Ephemeris* e) {
  const Times t = take_galileo(&r, e);
  e->group_delay_s[1] = r.scaled_signed(10, -32);
  const std::uint32_t e5b_health = r.take(2), e5b_invalid = r.take(1);
  const std::uint32_t e1b_health = r.take(2), e1b_invalid = r.take(1);
  e->health = static_cast<std::uint16_t>(e1b_invalid | (e1b_health << 1) | (e5b_invalid << 6) |
                                         (e5b_health << 7));
  return t;
}

// Bits of each message up to its last field, its number included.
std::size_t bits_of(std::uint16_t message_number) {
  switch (message_number) {
    case kGpsEphemeris:
      return 488;
    case kBeidouEphemeris:
      return 511;
    case kGalileoFnavEphemeris:
      return 496;
    default:
      return 504;
  }
}

Times take_elements(std::uint16_t message_number, const BitReader& reader, Ephemeris* e) {
  switch (message_number) {
    case kGpsEphemeris:
      e->message = NavigationMessage::kGpsLnav;
      return take_gps(reader, e);
    case kBeidouEphemeris:
      e->message = is_beidou_geostationary(e->satellite) ? NavigationMessage::kBeidouD2
                                                         : NavigationMessage::kBeidouD1;
      return take_beidou(reader, e);
    case kGalileoFnavEphemeris:
      e->message = NavigationMessage::kGalileoFnav;
      return take_fnav(reader, e);
    default:
      e->message = NavigationMessage::kGalileoInav;
      return take_inav(reader, e);
  }
}

System system_of(std::uint16_t message_number) {
  switch (message_number) {
    case kGpsEphemeris:
      return System::kGps;
    case kBeidouEphemeris:
      return System::kBeidou;
    default:
      return System::kGalileo;
  }
}

// The GPS week that the message states.
int stated_week(System system, int week, GpsTime near) {
  if (system == System::kBeidou)
    return full_week(week + kBeidouWeekZeroInGpsWeeks, kBeidouWeekModulus, near.week());
  return system == System::kGalileo
             ? full_week(week + kGalileoWeekZeroInGpsWeeks, kGalileoWeekModulus, near.week())
             : full_week(week, kGpsWeekModulus, near.week());
}

}  // namespace

bool is_broadcast_ephemeris(std::uint16_t message_number) {
  return message_number == kGpsEphemeris || message_number == kBeidouEphemeris ||
         message_number == kGalileoFnavEphemeris || message_number == kGalileoInavEphemeris;
}

EphemerisStatus decode_ephemeris(std::uint16_t message_number,
                                 std::span<const std::uint8_t> message, GpsTime near,
                                 Ephemeris* ephemeris, GpsTime* stated_toe) {
  if (message.size() * 8 < bits_of(message_number)) return EphemerisStatus::kBadLength;
  const System system = system_of(message_number);
  const bool is_beidou = system == System::kBeidou;
  BitReader reader(message);
  Ephemeris e;
  e.satellite = {system, static_cast<std::uint16_t>(reader.skip(12).take(6))};
  if (!is_valid(e.satellite)) return EphemerisStatus::kBadSatellite;
  const Times times = take_elements(message_number, reader, &e);
  if (times.toe_s >= kSecondsPerWeek || times.toc_s >= kSecondsPerWeek) {
    return EphemerisStatus::kBadTime;
  }
  const int week = stated_week(system, times.week, near);
  const std::int64_t gps_s = times.toe_s - (is_beidou ? kBeidouMinusGpsSeconds : 0);
  *stated_toe =
      GpsTime::from_nanoseconds(week * kNanosecondsPerWeek + gps_s * kNanosecondsPerSecond);
  // Receiver and satellite may be on two sides of a week's end.
  if (std::abs(week - near.week()) > 1) return EphemerisStatus::kBadWeek;
  const auto instant = [&](std::int64_t s) {
    return is_beidou ? nearest_beidou_instant(s, near) : nearest_instant(s, near);
  };
  e.toe = instant(times.toe_s);
  e.toc = instant(times.toc_s);
  if (!is_sane(e)) return EphemerisStatus::kNotSane;
  *ephemeris = e;
  return EphemerisStatus::kOk;
}

bool is_of_other_week(GpsTime stated_toe, GpsTime near) {
  // Elements serve for two hours before and behind their reference time, GPS's longest sets for
  // three; the week that is stated is that of either time.
  constexpr std::int64_t kNearEnd_ns = 4 * 3600 * kNanosecondsPerSecond;
  const int week = near.plus_nanoseconds(-kNearEnd_ns).week();
  return week == near.plus_nanoseconds(kNearEnd_ns).week() && stated_toe.week() != week;
}

}  // namespace leonav
