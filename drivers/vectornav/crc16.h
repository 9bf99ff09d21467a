// This header computes the checksum of VectorNav messages: CRC-16 with the polynomial x^16 + x^12 +
// x^5 + 1, initial value zero, most significant bit first.
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

constexpr std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0;
  for (const std::uint8_t byte : bytes) crc = crc16_next(crc, byte);
  return crc;
}

}  // namespace leonav
