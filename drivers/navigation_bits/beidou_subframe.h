// This unit reads what BeiDou's D1 and D2 messages have in common: words, error check, header.
// Source: BDS-SIS-ICD-B1I 3.0, section 5.1.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace leonav {

inline constexpr std::size_t kBeidouWords = 10;
inline constexpr double kBeidouGroupDelayUnit = 1e-10;  // s

// A subframe's information bits: 26 in word one and 22 in each of the others. Check bits are left
// out, so that a field split over two words reads as one.
struct BeidouSubframe {
  static constexpr std::size_t kHeaderBits = 38;  // preamble, reserved, number, seconds of week
  std::array<std::uint8_t, 28> bits{};
  std::uint32_t number = 0;  // "FraID"
  std::uint32_t sow_s = 0;   // BeiDou seconds of week at the start of the subframe
};

// Reads ten words of 30 bits, right-aligned. Returns nullopt if the preamble or a BCH(15,11) check
// is wrong, or a header field is out of range. (The receiver corrects single errors before it sends
// the words.)
std::optional<BeidouSubframe> read_beidou_subframe(
    std::span<const std::uint32_t, kBeidouWords> words);

// Returns the four check bits of 11 information bits, generator x^4 + x + 1 (5.1.3).
constexpr std::uint32_t beidou_bch(std::uint32_t information) {
  std::uint32_t remainder = 0;
  for (int i = 10; i >= 0; --i) {
    const std::uint32_t feedback = ((remainder >> 3) ^ (information >> i)) & 1u;
    remainder = (remainder << 1) & 0xF;
    if (feedback) remainder ^= 0x3;
  }
  return remainder;
}

}  // namespace leonav
