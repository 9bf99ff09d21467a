#include "drivers/navigation_bits/gps_lnav.h"

#include <algorithm>
#include <bit>

#include "drivers/binary/bit_field.h"
#include "drivers/binary/week_time.h"

namespace leonav {
namespace {

constexpr std::uint32_t kKlobucharPageId = 56;  // "SV ID" of page 18 (table 20-V)
constexpr std::uint32_t kGpsDataId = 1;         // "01": the structure of IS-GPS-200

// Each rule has the data bits of a word that enter parity bit D25..D30, and which of the previous
// word's last two bits does (IS-GPS-200N table 20-XIV); bit 23 is d1.
struct ParityRule {
  std::uint32_t mask;
  bool uses_d29;
};
constexpr std::array<ParityRule, 6> kParityRules = {{
    {0b1110'1100'0111'1100'1101'0010, true},
    {0b0111'0110'0011'1110'0110'1001, false},
    {0b1011'1011'0001'1111'0011'0100, true},
    {0b0101'1101'1000'1111'1001'1010, false},
    {0b1010'1110'1100'0111'1100'1101, false},
    {0b0010'1101'1110'1010'0010'0111, true},
}};

KlobucharModel decode_klobuchar(BitReader r) {
  KlobucharModel model;
  constexpr std::array<int, 4> kAlphaPower = {-30, -27, -24, -24};
  constexpr std::array<int, 4> kBetaPower = {11, 14, 16, 16};
  for (std::size_t i = 0; i < 4; ++i) model.alpha[i] = r.scaled_signed(8, kAlphaPower[i]);
  for (std::size_t i = 0; i < 4; ++i) model.beta[i] = r.scaled_signed(8, kBetaPower[i]);
  model.valid = true;
  return model;
}

}  // namespace

bool gps_parity_is_good(std::span<const std::uint32_t, GpsLnav::kWords> words) {
  for (const std::uint32_t word : words) {
    const std::uint32_t data = (word >> 6) & 0xFFFFFF;
    const std::uint32_t d29 = word >> 31, d30 = (word >> 30) & 1u;
    for (std::size_t i = 0; i < kParityRules.size(); ++i) {
      const std::uint32_t previous = kParityRules[i].uses_d29 ? d29 : d30;
      const std::uint32_t expected = (std::popcount(data & kParityRules[i].mask) + previous) & 1u;
      if (((word >> (5 - i)) & 1u) != expected) return false;
    }
  }
  return true;
}

SubframeStatus GpsLnav::add(std::span<const std::uint32_t, kWords> words,
                            const SubframeOrigin& origin, NavigationUpdate* update) {
  if (!gps_parity_is_good(words)) return SubframeStatus::kBadParity;
  BitWriter<30> writer;
  for (const std::uint32_t word : words) writer.put(word >> 6, 24);
  const GpsLnavBits& bits = writer.bytes();
  const std::optional<GpsLnavHead> head = read_gps_lnav_head(bits);
  if (!head) return SubframeStatus::kBadParity;

  if (head->number == 4) {
    BitReader page(bits);
    const std::uint32_t data_id = page.skip(48).take(2);
    if (data_id != kGpsDataId || page.take(6) != kKlobucharPageId) {
      return SubframeStatus::kOtherMessage;
    }
    update->klobuchar = decode_klobuchar(page);
    return SubframeStatus::kUsed;
  }
  if (head->number < 1 || head->number > 3) return SubframeStatus::kOtherMessage;

  const GpsTime sent = nearest_instant(head->sent_tow_s, origin.now);
  if (head->number == 1 && !gps_lnav_week_agrees(bits, sent)) return SubframeStatus::kBadWeek;
  subframes_[head->number - 1] = {bits, sent};
  if (is_complete()) update->ephemeris = decode(origin);
  return SubframeStatus::kUsed;
}

bool GpsLnav::is_complete() const {
  const auto& [first, second, third] = subframes_;
  return are_contemporary(first.sent, second.sent) && are_contemporary(second.sent, third.sent) &&
         gps_lnav_issues_agree(first.bits, second.bits, third.bits);
}

Ephemeris GpsLnav::decode(const SubframeOrigin& origin) const {
  const auto& [first, second, third] = subframes_;
  return decode_gps_lnav(origin.satellite, std::max({first.sent, second.sent, third.sent}),
                         first.bits, second.bits, third.bits);
}

}  // namespace leonav
