// This header computes the checksum of VectorNav messages and of SBF blocks: CRC-16 with the
// polynomial x^16 + x^12 + x^5 + 1, initial value zero, most significant bit first.
#pragma once
#include <cstdint>
#include <span>

namespace leonav {

// Returns the checksum of the bytes so far and `byte`.
constexpr std::uint16_t crc16_next(std::uint16_t crc, std::uint8_t byte) {
  crc = static_cast<std::uint16_t>(crc ^ (byte << 8));
  for (int bit = 0; bit < 8; ++bit) {
    const bool carries = (crc & 0x8000) != 0;
    crc = static_cast<std::uint16_t>(crc << 1);
    if (carries) crc ^= 0x1021;
  }
  return crc;
}

// Returns the product of two remainders modulo the polynomial. A checksum moved on by n bytes of
// zeros is its product with that of x^(8n).
constexpr std::uint16_t crc16_product(std::uint16_t a, std::uint16_t b) {
  std::uint16_t product = 0;
  for (int bit = 15; bit >= 0; --bit) {
    const bool carries = (product & 0x8000) != 0;
    product = static_cast<std::uint16_t>(product << 1);
    if (carries) product ^= 0x1021;
    if ((a >> bit) & 1) product ^= b;
  }
  return product;
}

constexpr std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0;
  for (const std::uint8_t byte : bytes) crc = crc16_next(crc, byte);
  return crc;
}

}  // namespace leonav
