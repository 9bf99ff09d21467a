#include "drivers/ubx/gps_lnav.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "drivers/binary/accuracy_index.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/week_time.h"

namespace leonav {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kPreamble = 0x8B;
constexpr int kWeekModulus = 1024;
constexpr int kSubframeSeconds = 6;
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

// Returns the subframe without TLM and HOW: the contents of words three to ten.
BitReader after_how(std::span<const std::uint8_t> bits) {
  BitReader reader(bits);
  reader.skip(48);
  return reader;
}

std::uint32_t issue_of_clock_low(std::span<const std::uint8_t> bits) {
  return BitReader(bits).skip(7 * 24).take(8);
}
std::uint32_t issue_of_subframe2(std::span<const std::uint8_t> bits) {
  return BitReader(bits).skip(48).take(8);
}
std::uint32_t issue_of_subframe3(std::span<const std::uint8_t> bits) {
  return BitReader(bits).skip(9 * 24).take(8);
}

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
  if (((words[0] >> 22) & 0xFF) != kPreamble || !gps_parity_is_good(words)) {
    return SubframeStatus::kBadParity;
  }
  BitWriter<30> writer;
  for (const std::uint32_t word : words) writer.put(word >> 6, 24);
  const Bits& bits = writer.bytes();

  BitReader how(bits);
  how.skip(24);
  const std::uint32_t next_count = how.take(17);  // of the next subframe, in 6 s
  const std::uint32_t number = how.skip(2).take(3);
  // With a time of week beyond the week the satellite marks a test (20.3.3.2 counts to 100799).
  if (next_count >= kSecondsPerWeek / kSubframeSeconds) return SubframeStatus::kBadParity;

  if (number == 4) {
    BitReader page = after_how(bits);
    const std::uint32_t data_id = page.take(2);
    if (data_id != kGpsDataId || page.take(6) != kKlobucharPageId) {
      return SubframeStatus::kOtherMessage;
    }
    update->klobuchar = decode_klobuchar(page);
    return SubframeStatus::kUsed;
  }
  if (number < 1 || number > 3) return SubframeStatus::kOtherMessage;

  const GpsTime sent = nearest_instant(
      static_cast<std::int64_t>(next_count) * kSubframeSeconds - kSubframeSeconds, origin.now);
  if (number == 1 &&
      !week_agrees(static_cast<int>(after_how(bits).take(10)), kWeekModulus, 0, sent)) {
    return SubframeStatus::kBadWeek;
  }
  subframes_[number - 1] = {bits, sent};
  if (is_complete()) update->ephemeris = decode(origin);
  return SubframeStatus::kUsed;
}

bool GpsLnav::is_complete() const {
  const auto& [first, second, third] = subframes_;
  if (!are_contemporary(first.sent, second.sent) || !are_contemporary(second.sent, third.sent)) {
    return false;
  }
  // A change of issue within the set appears as different numbers (20.3.3.4.1).
  const std::uint32_t issue = issue_of_subframe2(second.bits);
  return issue == issue_of_clock_low(first.bits) && issue == issue_of_subframe3(third.bits);
}

Ephemeris GpsLnav::decode(const SubframeOrigin& origin) const {
  Ephemeris e;
  e.satellite = origin.satellite;
  e.message = NavigationMessage::kGpsLnav;
  e.transmission_time = std::max({subframes_[0].sent, subframes_[1].sent, subframes_[2].sent});

  BitReader r = after_how(subframes_[0].bits);
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

  r = after_how(subframes_[1].bits);
  e.issue = static_cast<std::uint16_t>(r.take(8));
  e.crs = r.scaled_signed(16, -5);
  e.delta_n = r.scaled_signed(16, -43) * kPi;
  e.m0 = r.scaled_signed(32, -31) * kPi;
  e.cuc = r.scaled_signed(16, -29);
  e.eccentricity = r.scaled(32, -33);
  e.cus = r.scaled_signed(16, -29);
  e.sqrt_a = r.scaled(32, -19);
  e.toe = nearest_instant(static_cast<std::int64_t>(r.take(16)) * 16, e.transmission_time);

  r = after_how(subframes_[2].bits);
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
