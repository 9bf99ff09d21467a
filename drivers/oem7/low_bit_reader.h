// This header reads the bit fields of compressed range logs, least significant bit first.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace leonav {

// The reader takes fields one after the other. Bits beyond the end read as zero and set overrun().
class LowBitReader {
 public:
  explicit constexpr LowBitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  // Returns the next `count` (0 to 64) bits as an unsigned number.
  constexpr std::uint64_t take(int count) {
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i, ++position_) {
      const std::size_t byte = position_ / 8;
      if (byte >= bytes_.size()) {
        overrun_ = true;
        continue;
      }
      value |= static_cast<std::uint64_t>((bytes_[byte] >> (position_ % 8)) & 1u) << i;
    }
    return value;
  }
  // Returns the next `count` (1 to 63) bits in two's complement.
  constexpr std::int64_t take_signed(int count) {
    const std::uint64_t sign = std::uint64_t{1} << (count - 1);
    return static_cast<std::int64_t>((take(count) ^ sign) - sign);
  }
  constexpr void skip(std::size_t count) {
    position_ += count;
    if (position_ > 8 * bytes_.size()) overrun_ = true;
  }
  constexpr bool overrun() const { return overrun_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
  bool overrun_ = false;
};

}  // namespace leonav
