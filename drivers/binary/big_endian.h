// This header reads big-endian numbers from the payload of a binary message.
#pragma once
#include <bit>
#include <cstdint>

namespace leonav {

// Each function reads an unsigned integer (u) or an IEEE 754 number (r) of 2, 4 or 8 bytes at `p`,
// its most significant byte first; the caller checks the length.
constexpr std::uint16_t read_big_u2(const std::uint8_t* p) {
  return static_cast<std::uint16_t>((p[0] << 8) | p[1]);
}
constexpr std::uint32_t read_big_u4(const std::uint8_t* p) {
  return (static_cast<std::uint32_t>(read_big_u2(p)) << 16) | read_big_u2(p + 2);
}
constexpr std::uint64_t read_big_u8(const std::uint8_t* p) {
  return (static_cast<std::uint64_t>(read_big_u4(p)) << 32) | read_big_u4(p + 4);
}
constexpr float read_big_r4(const std::uint8_t* p) { return std::bit_cast<float>(read_big_u4(p)); }
constexpr double read_big_r8(const std::uint8_t* p) {
  return std::bit_cast<double>(read_big_u8(p));
}

}  // namespace leonav
