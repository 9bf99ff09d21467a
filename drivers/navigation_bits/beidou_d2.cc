#include "drivers/navigation_bits/beidou_d2.h"

#include "core/base/angle.h"
#include "drivers/binary/accuracy_index.h"
#include "drivers/binary/beidou_time.h"
#include "drivers/binary/bit_field.h"

namespace leonav {
namespace {

constexpr int kFrameSeconds = 3;  // one page of subframe 1 per frame
constexpr std::size_t kPageHeaderBits = BeidouSubframe::kHeaderBits + 4;  // with the page number

BitReader after_page_number(const BeidouSubframe& subframe) {
  BitReader reader(subframe.bits);
  reader.skip(kPageHeaderBits);
  return reader;
}

}  // namespace

SubframeStatus BeidouD2::add(std::span<const std::uint32_t, kBeidouWords> words,
                             const SubframeOrigin& origin, NavigationUpdate* update) {
  const std::optional<BeidouSubframe> subframe = read_beidou_subframe(words);
  if (!subframe) return SubframeStatus::kBadParity;
  if (subframe->number != 1) return SubframeStatus::kOtherMessage;
  const std::uint32_t page = BitReader(subframe->bits).skip(BeidouSubframe::kHeaderBits).take(4);
  if (page < 1 || page > kPages) return SubframeStatus::kBadParity;
  const GpsTime sent = nearest_beidou_instant(subframe->sow_s, origin.now);
  if (page == 1) {
    const auto week = static_cast<int>(after_page_number(*subframe).skip(1 + 5 + 4).take(13));
    if (!beidou_week_agrees(week, sent)) return SubframeStatus::kBadWeek;
  }
  parts_[page - 1] = {*subframe, sent};
  if (is_complete()) update->ephemeris = decode(origin);
  return SubframeStatus::kUsed;
}

// The elements are split over pages that no issue number joins, so all ten must be of one round.
bool BeidouD2::is_complete() const {
  if (!parts_[0].sent.is_set()) return false;
  for (std::size_t i = 1; i < kPages; ++i) {
    const GpsTime expected = parts_[0].sent.plus_nanoseconds(static_cast<std::int64_t>(i) *
                                                             kFrameSeconds * kNanosecondsPerSecond);
    if (parts_[i].sent != expected) return false;
  }
  return true;
}

Ephemeris BeidouD2::decode(const SubframeOrigin& origin) const {
  Ephemeris e;
  e.satellite = origin.satellite;
  e.message = NavigationMessage::kBeidouD2;
  e.transmission_time = parts_[kPages - 1].sent;

  BitReader r = after_page_number(parts_[0].subframe);
  e.health = static_cast<std::uint16_t>(r.take(1));
  e.issue_clock = static_cast<std::uint16_t>(r.take(5));
  e.accuracy_m = nominal_accuracy_m(r.take(4));
  r.skip(13);  // week
  e.toc = nearest_beidou_instant(static_cast<std::int64_t>(r.take(17)) * 8, e.transmission_time);
  e.group_delay_s[0] = r.take_signed(10) * kBeidouGroupDelayUnit;
  e.group_delay_s[1] = r.take_signed(10) * kBeidouGroupDelayUnit;

  // The elements of all pages are joined into one run of bits, so that a field that a page boundary
  // splits reads as one. Page 2 holds the ionosphere coefficients, which are not used.
  struct Piece {
    std::size_t page, skip;  // bits after the page number that are not elements
    int count;
  };
  constexpr std::array<Piece, 8> kPieces = {{
      {3, 6 + 22 + 10, 12 + 12 + 4},         // a0, a1 (high)
      {4, 0, 6 + 22 + 22 + 14},              // a1 (low), a2, AODE, delta n, Cuc (high)
      {5, 0, 6 + 22 + 22 + 14},              // Cuc (low), M0, Cus, e (high)
      {6, 0, 6 + 22 + 22 + 14},              // e (low), sqrt A, Cic (high)
      {7, 0, 6 + 22 + 22 + 14},              // Cic (low), Cis, toe, i0 (high)
      {8, 0, 6 + 5 + 17 + 1 + 18 + 3 + 16},  // i0 (low), Crc, Crs, omega dot (high)
      {9, 0, 6 + 22 + 22 + 14},              // omega dot (low), Omega0, omega (high)
      {10, 0, 6 + 13},                       // omega (low), i dot
  }};
  BitWriter<64> run;
  for (const Piece& piece : kPieces) {
    BitReader page = after_page_number(parts_[piece.page - 1].subframe);
    page.skip(piece.skip);
    for (int i = 0; i < piece.count; ++i) run.put(page.take(1), 1);
  }
  r = BitReader(run.bytes());
  e.af0 = r.scaled_signed(24, -33);
  e.af1 = r.scaled_signed(22, -50);
  e.af2 = r.scaled_signed(11, -66);
  e.issue = static_cast<std::uint16_t>(r.take(5));
  e.delta_n = r.scaled_signed(16, -43) * kPi;
  e.cuc = r.scaled_signed(18, -31);
  e.m0 = r.scaled_signed(32, -31) * kPi;
  e.cus = r.scaled_signed(18, -31);
  e.eccentricity = r.scaled(32, -33);
  e.sqrt_a = r.scaled(32, -19);
  e.cic = r.scaled_signed(18, -31);
  e.cis = r.scaled_signed(18, -31);
  e.toe = nearest_beidou_instant(static_cast<std::int64_t>(r.take(17)) * 8, e.transmission_time);
  e.i0 = r.scaled_signed(32, -31) * kPi;
  e.crc = r.scaled_signed(18, -6);
  e.crs = r.scaled_signed(18, -6);
  e.omega_dot = r.scaled_signed(24, -43) * kPi;
  e.omega0 = r.scaled_signed(32, -31) * kPi;
  e.omega = r.scaled_signed(32, -31) * kPi;
  e.i_dot = r.scaled_signed(14, -43) * kPi;
  return e;
}

}  // namespace leonav
