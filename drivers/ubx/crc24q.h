// CRC-24Q, as Galileo and SBAS pages carry it.
#pragma once
#include <cstdint>

#include "drivers/ubx/bit_field.h"

namespace leonav {

// Checksum of the next `count` bits. Generator x^24 + x^23 + x^18 + x^17 + x^14 + x^11 + x^10 +
// x^7 + x^6 + x^5 + x^4 + x^3 + x + 1 (Galileo OS-SIS-ICD 2.1, 5.1.9.4).
constexpr std::uint32_t crc24q(BitReader bits, int count) {
  constexpr std::uint32_t kGenerator = 0x864CFB;
  std::uint32_t crc = 0;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t feedback = ((crc >> 23) ^ bits.take(1)) & 1u;
    crc = (crc << 1) & 0xFFFFFF;
    if (feedback) crc ^= kGenerator;
  }
  return crc;
}

}  // namespace leonav
