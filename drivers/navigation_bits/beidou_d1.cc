#include "drivers/navigation_bits/beidou_d1.h"

#include "core/base/angle.h"
#include "drivers/binary/accuracy_index.h"
#include "drivers/binary/beidou_time.h"
#include "drivers/binary/bit_field.h"

namespace leonav {
namespace {

constexpr int kSubframeSeconds = 6;

BitReader after_header(const BeidouSubframe& subframe) {
  BitReader reader(subframe.bits);
  reader.skip(BeidouSubframe::kHeaderBits);
  return reader;
}

}  // namespace

SubframeStatus BeidouD1::add(std::span<const std::uint32_t, kBeidouWords> words,
                             const SubframeOrigin& origin, NavigationUpdate* update) {
  const std::optional<BeidouSubframe> subframe = read_beidou_subframe(words);
  if (!subframe) return SubframeStatus::kBadParity;
  if (subframe->number > parts_.size()) return SubframeStatus::kOtherMessage;
  const GpsTime sent = nearest_beidou_instant(subframe->sow_s, origin.now);
  if (subframe->number == 1) {
    const auto week = static_cast<int>(after_header(*subframe).skip(1 + 5 + 4).take(13));
    if (!beidou_week_agrees(week, sent)) return SubframeStatus::kBadWeek;
  }
  parts_[subframe->number - 1] = {*subframe, sent};
  if (is_complete()) update->ephemeris = decode(origin);
  return SubframeStatus::kUsed;
}

// The reference time is split over subframes 2 and 3 and no issue number joins the three subframes,
// so they must be of one frame.
bool BeidouD1::is_complete() const {
  if (!parts_[0].sent.is_set()) return false;
  for (std::size_t i = 1; i < parts_.size(); ++i) {
    const GpsTime expected = parts_[0].sent.plus_nanoseconds(
        static_cast<std::int64_t>(i) * kSubframeSeconds * kNanosecondsPerSecond);
    if (parts_[i].sent != expected) return false;
  }
  return true;
}

Ephemeris BeidouD1::decode(const SubframeOrigin& origin) const {
  Ephemeris e;
  e.satellite = origin.satellite;
  e.message = NavigationMessage::kBeidouD1;
  e.transmission_time = parts_[2].sent;

  BitReader r = after_header(parts_[0].subframe);
  e.health = static_cast<std::uint16_t>(r.take(1));
  e.issue_clock = static_cast<std::uint16_t>(r.take(5));
  e.accuracy_m = nominal_accuracy_m(r.take(4));
  r.skip(13);  // week
  e.toc = nearest_beidou_instant(static_cast<std::int64_t>(r.take(17)) * 8, e.transmission_time);
  e.group_delay_s[0] = r.take_signed(10) * kBeidouGroupDelayUnit;
  e.group_delay_s[1] = r.take_signed(10) * kBeidouGroupDelayUnit;
  r.skip(8 * 8);  // BeiDou's own ionosphere coefficients
  e.af2 = r.scaled_signed(11, -66);
  e.af0 = r.scaled_signed(24, -33);
  e.af1 = r.scaled_signed(22, -50);
  e.issue = static_cast<std::uint16_t>(r.take(5));

  r = after_header(parts_[1].subframe);
  e.delta_n = r.scaled_signed(16, -43) * kPi;
  e.cuc = r.scaled_signed(18, -31);
  e.m0 = r.scaled_signed(32, -31) * kPi;
  e.eccentricity = r.scaled(32, -33);
  e.cus = r.scaled_signed(18, -31);
  e.crc = r.scaled_signed(18, -6);
  e.crs = r.scaled_signed(18, -6);
  e.sqrt_a = r.scaled(32, -19);
  const std::uint32_t toe_high = r.take(2);

  r = after_header(parts_[2].subframe);
  const std::uint32_t toe = (toe_high << 15) | r.take(15);
  e.toe = nearest_beidou_instant(static_cast<std::int64_t>(toe) * 8, e.transmission_time);
  e.i0 = r.scaled_signed(32, -31) * kPi;
  e.cic = r.scaled_signed(18, -31);
  e.omega_dot = r.scaled_signed(24, -43) * kPi;
  e.cis = r.scaled_signed(18, -31);
  e.i_dot = r.scaled_signed(14, -43) * kPi;
  e.omega0 = r.scaled_signed(32, -31) * kPi;
  e.omega = r.scaled_signed(32, -31) * kPi;
  return e;
}

}  // namespace leonav
