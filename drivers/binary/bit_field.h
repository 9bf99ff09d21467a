// This header reads and writes the bit fields of navigation messages, most significant bit first,
// as in the figures of the interface documents.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace leonav {

// The reader takes fields one after the other. Bits beyond the end read as zero and set overrun().
class BitReader {
 public:
  explicit constexpr BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  // Returns the next `count` (0 to 32) bits as an unsigned number.
  constexpr std::uint32_t take(int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i, ++position_) {
      const std::size_t byte = position_ / 8;
      if (byte >= bytes_.size()) overrun_ = true;
      const std::uint32_t bit =
          byte < bytes_.size() ? (bytes_[byte] >> (7 - position_ % 8)) & 1u : 0u;
      value = (value << 1) | bit;
    }
    return value;
  }
  // Returns the next `count` (1 to 32) bits in two's complement.
  constexpr std::int32_t take_signed(int count) {
    const std::uint32_t raw = take(count);
    const std::uint32_t sign = std::uint32_t{1} << (count - 1);
    // (x ^ s) - s extends the sign without a shift of a negative number.
    return static_cast<std::int32_t>((raw ^ sign) - sign);
  }
  // Return the next bits times 2^power.
  double scaled(int count, int power) {
    return std::ldexp(static_cast<double>(take(count)), power);
  }
  double scaled_signed(int count, int power) {
    return std::ldexp(static_cast<double>(take_signed(count)), power);
  }
  constexpr BitReader& skip(std::size_t count) {
    position_ += count;
    return *this;
  }
  constexpr std::size_t position() const { return position_; }
  constexpr bool overrun() const { return overrun_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
  bool overrun_ = false;
};

// The writer puts fields one after the other into a fixed buffer; bits that do not fit are dropped.
template <std::size_t kBytes>
class BitWriter {
 public:
  // Writes the `count` (0 to 32) least significant bits of `value`.
  constexpr void put(std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i, ++position_) {
      if (position_ / 8 >= kBytes) continue;
      if ((value >> i) & 1u) {
        bytes_[position_ / 8] |= static_cast<std::uint8_t>(0x80u >> (position_ % 8));
      }
    }
  }
  constexpr const std::array<std::uint8_t, kBytes>& bytes() const { return bytes_; }
  constexpr std::size_t position() const { return position_; }

 private:
  std::array<std::uint8_t, kBytes> bytes_{};
  std::size_t position_ = 0;
};

}  // namespace leonav
