#include "drivers/navigation_bits/galileo_fnav.h"

#include <algorithm>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "drivers/binary/accuracy_index.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/crc24q.h"
#include "drivers/binary/week_time.h"

namespace leonav {
namespace {

constexpr int kCovered = 6 + 208;  // bits under the CRC

// Position of the issue of data and of the time of week in each page type, from the page's first
// bit.
struct Position {
  std::size_t issue, tow;
  bool has_week;  // 12 bits, before the time of week
};
constexpr std::array<Position, 4> kPositions = {{
    {12, 6 + 161, true},
    {6, 6 + 188, true},
    {6, 6 + 180, true},
    {6, 6 + 183, false},
}};

std::uint32_t issue_of(std::span<const std::uint8_t> bits, std::size_t type) {
  return BitReader(bits).skip(kPositions[type - 1].issue).take(10);
}

}  // namespace

SubframeStatus GalileoFnav::add(std::span<const std::uint32_t, kWords> words,
                                const SubframeOrigin& origin, NavigationUpdate* update) {
  BitWriter<32> page;
  for (const std::uint32_t word : words) page.put(word, 32);
  const Bits& bits = page.bytes();
  if (crc24q(BitReader(bits), kCovered) != BitReader(bits).skip(kCovered).take(24)) {
    return SubframeStatus::kBadParity;
  }
  const std::uint32_t type = BitReader(bits).take(6);
  if (type < 1 || type > pages_.size()) return SubframeStatus::kOtherMessage;

  // Page 1 has its satellite's number; another number is a page received by cross-correlation.
  if (type == 1 && BitReader(bits).skip(6).take(6) != origin.satellite.number) {
    return SubframeStatus::kWrongSatellite;
  }
  const Position& position = kPositions[type - 1];
  const std::uint32_t tow_s = BitReader(bits).skip(position.tow).take(20);
  if (tow_s >= kSecondsPerWeek) return SubframeStatus::kBadParity;
  const GpsTime sent = nearest_instant(tow_s, origin.now);
  if (position.has_week) {
    const auto week = static_cast<int>(BitReader(bits).skip(position.tow - 12).take(12));
    if (!week_agrees(week, kGalileoWeekModulus, kGalileoWeekZeroInGpsWeeks, sent)) {
      return SubframeStatus::kBadWeek;
    }
  }
  pages_[type - 1] = {bits, sent};
  if (is_complete()) update->ephemeris = decode(origin);
  return SubframeStatus::kUsed;
}

bool GalileoFnav::is_complete() const {
  const std::uint32_t issue = issue_of(pages_[0].bits, 1);
  for (std::size_t type = 2; type <= pages_.size(); ++type) {
    const Page& page = pages_[type - 1];
    if (!are_contemporary(pages_[0].sent, page.sent)) return false;
    if (issue_of(page.bits, type) != issue) return false;
  }
  return true;
}

Ephemeris GalileoFnav::decode(const SubframeOrigin& origin) const {
  Ephemeris e;
  e.satellite = origin.satellite;
  e.message = NavigationMessage::kGalileoFnav;
  e.transmission_time = std::max({pages_[0].sent, pages_[1].sent, pages_[2].sent, pages_[3].sent});

  BitReader r(pages_[0].bits);
  e.issue = static_cast<std::uint16_t>(r.skip(12).take(10));
  e.toc = nearest_instant(static_cast<std::int64_t>(r.take(14)) * 60, e.transmission_time);
  e.af0 = r.scaled_signed(31, -34);
  e.af1 = r.scaled_signed(21, -46);
  e.af2 = r.scaled_signed(6, -59);
  e.accuracy_m = galileo_sisa_m(r.take(8));
  r.skip(11 + 11 + 14 + 5);  // effective ionisation level, storm flags
  e.group_delay_s[0] = r.scaled_signed(10, -32);
  const std::uint32_t e5a_health = r.take(2);
  const std::uint32_t e5a_invalid = r.skip(12 + 20).take(1);
  e.health = static_cast<std::uint16_t>((e5a_invalid << 3) | (e5a_health << 4));  // as RINEX

  r = BitReader(pages_[1].bits);
  e.m0 = r.skip(16).scaled_signed(32, -31) * kPi;
  e.omega_dot = r.scaled_signed(24, -43) * kPi;
  e.eccentricity = r.scaled(32, -33);
  e.sqrt_a = r.scaled(32, -19);
  e.omega0 = r.scaled_signed(32, -31) * kPi;
  e.i_dot = r.scaled_signed(14, -43) * kPi;

  r = BitReader(pages_[2].bits);
  e.i0 = r.skip(16).scaled_signed(32, -31) * kPi;
  e.omega = r.scaled_signed(32, -31) * kPi;
  e.delta_n = r.scaled_signed(16, -43) * kPi;
  e.cuc = r.scaled_signed(16, -29);
  e.cus = r.scaled_signed(16, -29);
  e.crc = r.scaled_signed(16, -5);
  e.crs = r.scaled_signed(16, -5);
  e.toe = nearest_instant(static_cast<std::int64_t>(r.take(14)) * 60, e.transmission_time);

  r = BitReader(pages_[3].bits);
  e.cic = r.skip(16).scaled_signed(16, -29);
  e.cis = r.scaled_signed(16, -29);
  return e;
}

}  // namespace leonav
