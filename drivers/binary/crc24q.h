// This header computes CRC-24Q, the checksum of Galileo and SBAS pages and RTCM 3 frames.
#pragma once
#include <array>
#include <cstdint>

#include "drivers/binary/bit_field.h"

namespace leonav {

// Returns the checksum `crc` continued by one bit. Generator x^24 + x^23 + x^18 + x^17 + x^14 +
// x^11 + x^10 + x^7 + x^6 + x^5 + x^4 + x^3 + x + 1 (Galileo OS-SIS-ICD 2.1, 5.1.9.4; RTCM 10403.3,
// 4.2).
constexpr std::uint32_t crc24q_with_bit(std::uint32_t crc, std::uint32_t bit) {
  constexpr std::uint32_t kGenerator = 0x864CFB;
  const std::uint32_t feedback = ((crc >> 23) ^ bit) & 1u;
  crc = (crc << 1) & 0xFFFFFF;
  return feedback ? crc ^ kGenerator : crc;
}

namespace crc24q_detail {

constexpr std::array<std::uint32_t, 256> byte_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
    std::uint32_t crc = 0;
    for (int shift = 7; shift >= 0; --shift) crc = crc24q_with_bit(crc, byte >> shift);
    table[byte] = crc;
  }
  return table;
}
inline constexpr std::array<std::uint32_t, 256> kByteTable = byte_table();

}  // namespace crc24q_detail

// Returns the checksum continued by one byte, highest bit first.
constexpr std::uint32_t crc24q_next(std::uint32_t crc, std::uint8_t byte) {
  return ((crc << 8) & 0xFFFFFF) ^ crc24q_detail::kByteTable[(crc >> 16) ^ byte];
}

// Returns the product of two remainders modulo the generator. A checksum moved on by n bytes of
// zeros is its product with that of x^(8n).
constexpr std::uint32_t crc24q_product(std::uint32_t a, std::uint32_t b) {
  std::uint32_t product = 0;
  for (int i = 23; i >= 0; --i) {
    product = crc24q_with_bit(product, 0);
    if ((b >> i) & 1u) product ^= a;
  }
  return product;
}

// Returns the checksum of the next `count` bits.
constexpr std::uint32_t crc24q(BitReader bits, int count) {
  std::uint32_t crc = 0;
  for (int i = 0; i < count; ++i)
    crc = crc24q_with_bit(crc, static_cast<std::uint32_t>(bits.take(1)));
  return crc;
}

}  // namespace leonav
