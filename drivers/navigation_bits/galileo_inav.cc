#include "drivers/navigation_bits/galileo_inav.h"

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "drivers/binary/accuracy_index.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/crc24q.h"
#include "drivers/binary/week_time.h"

namespace leonav {
namespace {

constexpr int kCoveredEven = 114;  // bits under the CRC: even part without its tail
constexpr int kCoveredOdd = 82;    // odd part up to the CRC

std::uint32_t issue_of(std::span<const std::uint8_t> bits) {
  return BitReader(bits).skip(6).take(10);
}

}  // namespace

SubframeStatus GalileoInav::add(std::span<const std::uint32_t, kWords> words,
                                const SubframeOrigin& origin, NavigationUpdate* update) {
  BitWriter<32> page;
  for (const std::uint32_t word : words) page.put(word, 32);
  BitReader even(page.bytes());
  BitReader odd(page.bytes());
  odd.skip(128);

  BitWriter<25> covered;
  BitReader copy_even = even, copy_odd = odd;
  for (int i = 0; i < kCoveredEven; ++i) covered.put(copy_even.take(1), 1);
  for (int i = 0; i < kCoveredOdd; ++i) covered.put(copy_odd.take(1), 1);
  if (crc24q(BitReader(covered.bytes()), kCoveredEven + kCoveredOdd) != copy_odd.take(24)) {
    return SubframeStatus::kBadParity;
  }
  const bool even_is_odd = even.take(1), even_is_alert = even.take(1);
  const bool odd_is_odd = odd.take(1), odd_is_alert = odd.take(1);
  if (even_is_odd || !odd_is_odd) return SubframeStatus::kBadParity;
  if (even_is_alert || odd_is_alert) return SubframeStatus::kOtherMessage;

  BitWriter<16> word;
  for (int i = 0; i < 112; ++i) word.put(even.take(1), 1);
  for (int i = 0; i < 16; ++i) word.put(odd.take(1), 1);
  const std::uint32_t type = BitReader(word.bytes()).take(6);
  if (type < 1 || type > words_.size()) return SubframeStatus::kOtherMessage;
  // Word 4 has its satellite's number; another number is a word received by cross-correlation.
  if (type == 4 && BitReader(word.bytes()).skip(16).take(6) != origin.satellite.number) {
    return SubframeStatus::kWrongSatellite;
  }
  if (type == 5) {
    BitReader time(word.bytes());
    time.skip(73);
    const auto week = static_cast<int>(time.take(12));
    const std::uint32_t tow_s = time.take(20);
    if (tow_s >= kSecondsPerWeek) return SubframeStatus::kBadParity;
    const GpsTime sent = nearest_instant(tow_s, origin.now);
    if (!week_agrees(week, kGalileoWeekModulus, kGalileoWeekZeroInGpsWeeks, sent)) {
      return SubframeStatus::kBadWeek;
    }
  }
  words_[type - 1] = {word.bytes(), origin.now};
  if (is_complete()) update->ephemeris = decode(origin);
  return SubframeStatus::kUsed;
}

bool GalileoInav::is_complete() const {
  for (std::size_t i = 1; i < words_.size(); ++i) {
    if (!are_contemporary(words_[0].received, words_[i].received)) return false;
  }
  // Word 5 has no issue of data: its contents do not depend on the issue.
  const std::uint32_t issue = issue_of(words_[0].bits);
  return issue == issue_of(words_[1].bits) && issue == issue_of(words_[2].bits) &&
         issue == issue_of(words_[3].bits);
}

Ephemeris GalileoInav::decode(const SubframeOrigin& origin) const {
  Ephemeris e;
  e.satellite = origin.satellite;
  e.message = NavigationMessage::kGalileoInav;

  BitReader r(words_[0].bits);
  e.issue = static_cast<std::uint16_t>(r.skip(6).take(10));
  e.toe = nearest_instant(static_cast<std::int64_t>(r.take(14)) * 60, origin.now);
  e.m0 = r.scaled_signed(32, -31) * kPi;
  e.eccentricity = r.scaled(32, -33);
  e.sqrt_a = r.scaled(32, -19);

  r = BitReader(words_[1].bits);
  e.omega0 = r.skip(16).scaled_signed(32, -31) * kPi;
  e.i0 = r.scaled_signed(32, -31) * kPi;
  e.omega = r.scaled_signed(32, -31) * kPi;
  e.i_dot = r.scaled_signed(14, -43) * kPi;

  r = BitReader(words_[2].bits);
  e.omega_dot = r.skip(16).scaled_signed(24, -43) * kPi;
  e.delta_n = r.scaled_signed(16, -43) * kPi;
  e.cuc = r.scaled_signed(16, -29);
  e.cus = r.scaled_signed(16, -29);
  e.crc = r.scaled_signed(16, -5);
  e.crs = r.scaled_signed(16, -5);
  e.accuracy_m = galileo_sisa_m(r.take(8));

  r = BitReader(words_[3].bits);
  e.cic = r.skip(16 + 6).scaled_signed(16, -29);
  e.cis = r.scaled_signed(16, -29);
  e.toc = nearest_instant(static_cast<std::int64_t>(r.take(14)) * 60, origin.now);
  e.af0 = r.scaled_signed(31, -34);
  e.af1 = r.scaled_signed(21, -46);
  e.af2 = r.scaled_signed(6, -59);

  r = BitReader(words_[4].bits);
  r.skip(6 + 11 + 11 + 14 + 5);  // type, effective ionisation level, storm flags
  e.group_delay_s = {r.scaled_signed(10, -32), 0.0};
  e.group_delay_s[1] = r.scaled_signed(10, -32);
  const std::uint32_t e5b_health = r.take(2), e1b_health = r.take(2);
  const std::uint32_t e5b_invalid = r.take(1), e1b_invalid = r.take(1);
  // The bits are packed as in RINEX: E1-B in bits 0-2, E5b in bits 6-8.
  e.health = static_cast<std::uint16_t>(e1b_invalid | (e1b_health << 1) | (e5b_invalid << 6) |
                                        (e5b_health << 7));
  e.transmission_time = nearest_instant(r.skip(12).take(20), origin.now);
  return e;
}

}  // namespace leonav
