#include "drivers/binary/gps_lnav_data.h"

#include "core/base/angle.h"
#include "drivers/binary/accuracy_index.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/week_time.h"

namespace leonav {
namespace {

constexpr std::uint32_t kPreamble = 0x8B;
constexpr int kWeekModulus = 1024;
constexpr int kSubframeSeconds = 6;

// Returns the subframe without TLM and HOW: the contents of words three to ten.
BitReader after_how(const GpsLnavBits& bits) {
  BitReader reader(bits);
  reader.skip(48);
  return reader;
}

std::uint32_t issue_of_clock_low(const GpsLnavBits& bits) {
  return BitReader(bits).skip(7 * 24).take(8);
}
std::uint32_t issue_of_subframe2(const GpsLnavBits& bits) {
  return BitReader(bits).skip(48).take(8);
}
std::uint32_t issue_of_subframe3(const GpsLnavBits& bits) {
  return BitReader(bits).skip(9 * 24).take(8);
}

}  // namespace

std::optional<GpsLnavHead> read_gps_lnav_head(const GpsLnavBits& subframe) {
  BitReader reader(subframe);
  if (reader.take(8) != kPreamble) return std::nullopt;
  const std::uint32_t next_count = reader.skip(16).take(17);  // of the next subframe, in 6 s
  // With a time of week beyond the week the satellite marks a test (20.3.3.2 counts to 100799).
  if (next_count >= kSecondsPerWeek / kSubframeSeconds) return std::nullopt;
  GpsLnavHead head;
  head.sent_tow_s = static_cast<std::int64_t>(next_count) * kSubframeSeconds - kSubframeSeconds;
  head.number = reader.skip(2).take(3);
  return head;
}

bool gps_lnav_week_agrees(const GpsLnavBits& subframe1, GpsTime time) {
  return week_agrees(static_cast<int>(after_how(subframe1).take(10)), kWeekModulus, 0, time);
}

bool gps_lnav_issues_agree(const GpsLnavBits& subframe1, const GpsLnavBits& subframe2,
                           const GpsLnavBits& subframe3) {
  const std::uint32_t issue = issue_of_subframe2(subframe2);
  return issue == issue_of_clock_low(subframe1) && issue == issue_of_subframe3(subframe3);
}

Ephemeris decode_gps_lnav(SatelliteId satellite, GpsTime transmission_time,
                          const GpsLnavBits& subframe1, const GpsLnavBits& subframe2,
                          const GpsLnavBits& subframe3) {
  Ephemeris e;
  e.satellite = satellite;
  e.message = NavigationMessage::kGpsLnav;
  e.transmission_time = transmission_time;

  BitReader r = after_how(subframe1);
  r.skip(10 + 2);  // week, code on L2
  e.accuracy_m = nominal_accuracy_m(r.take(4));
  e.health = static_cast<std::uint16_t>(r.take(6));
  const std::uint32_t issue_clock_high = r.take(2);
  e.group_delay_s[0] = r.skip(24 * 4 - 8).scaled_signed(8, -31);
  e.issue_clock = static_cast<std::uint16_t>((issue_clock_high << 8) | r.take(8));
  e.toc = nearest_instant(static_cast<std::int64_t>(r.take(16)) * 16, e.transmission_time);
  e.af2 = r.scaled_signed(8, -55);
  e.af1 = r.scaled_signed(16, -43);
  e.af0 = r.scaled_signed(22, -31);

  r = after_how(subframe2);
  e.issue = static_cast<std::uint16_t>(r.take(8));
  e.crs = r.scaled_signed(16, -5);
  e.delta_n = r.scaled_signed(16, -43) * kPi;
  e.m0 = r.scaled_signed(32, -31) * kPi;
  e.cuc = r.scaled_signed(16, -29);
  e.eccentricity = r.scaled(32, -33);
  e.cus = r.scaled_signed(16, -29);
  e.sqrt_a = r.scaled(32, -19);
  e.toe = nearest_instant(static_cast<std::int64_t>(r.take(16)) * 16, e.transmission_time);

  r = after_how(subframe3);
  e.cic = r.scaled_signed(16, -29);
  e.omega0 = r.scaled_signed(32, -31) * kPi;
  e.cis = r.scaled_signed(16, -29);
  e.i0 = r.scaled_signed(32, -31) * kPi;
  e.crc = r.scaled_signed(16, -5);
  e.omega = r.scaled_signed(32, -31) * kPi;
  e.omega_dot = r.scaled_signed(24, -43) * kPi;
  e.i_dot = r.skip(8).scaled_signed(14, -43) * kPi;
  return e;
}

}  // namespace leonav
