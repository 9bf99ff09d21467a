// This header computes the CRC-32 of NovAtel messages.
#pragma once
#include <array>
#include <cstdint>

namespace leonav {
namespace crc32_detail {

// x^32 + x^26 + x^23 + x^22 + x^16 + x^12 + x^11 + x^10 + x^8 + x^7 + x^5 + x^4 + x^2 + x + 1 with
// its bits in reverse: bit 31 is x^0.
constexpr std::uint32_t kGenerator = 0xEDB88320;

constexpr std::uint32_t times_x(std::uint32_t a) { return (a >> 1) ^ ((a & 1u) * kGenerator); }

constexpr std::array<std::uint32_t, 256> byte_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
    std::uint32_t crc = byte;
    for (int i = 0; i < 8; ++i) crc = times_x(crc);
    table[byte] = crc;
  }
  return table;
}
inline constexpr std::array<std::uint32_t, 256> kByteTable = byte_table();

}  // namespace crc32_detail

// Returns the checksum continued by one byte. It begins with 0 and is not inverted at the end, so
// that over bytes and their own checksum, least significant byte first, it is 0. Source: OEM7
// Commands and Logs Reference Manual, 32-Bit CRC.
constexpr std::uint32_t crc32_next(std::uint32_t crc, std::uint8_t byte) {
  return (crc >> 8) ^ crc32_detail::kByteTable[(crc ^ byte) & 0xFFu];
}

// Returns the product of two remainders modulo the generator. A checksum moved on by n bytes of
// zeros is its product with that of x^(8n).
constexpr std::uint32_t crc32_product(std::uint32_t a, std::uint32_t b) {
  std::uint32_t product = 0;
  for (int bit = 31; bit >= 0; --bit) {
    if ((a >> bit) & 1u) product ^= b;
    b = crc32_detail::times_x(b);
  }
  return product;
}

}  // namespace leonav
