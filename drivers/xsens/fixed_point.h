// This unit reads numbers in the four precisions of Xsens groups.
//
// Source: MT0101P, MTData2, "Precision": 0 IEEE 754 of 4 bytes; 1 fixed point 12.20, a signed
// integer of 4 bytes in steps of 2^-20; 2 fixed point 16.32, of 6 bytes in steps of 2^-32, whose 4
// bytes of fraction come before the 2 bytes of the signed whole part; 3 IEEE 754 of 8 bytes. Within
// each part the most significant byte is the first.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/binary/big_endian.h"

namespace leonav {

// Returns how many bytes a number takes.
constexpr std::size_t xsens_number_bytes(int precision) {
  constexpr std::array<std::size_t, 4> kBytes = {4, 4, 6, 8};
  return kBytes[static_cast<std::size_t>(precision)];
}

// Reads one number; the caller checks the length. Precondition: 0 <= precision <= 3.
constexpr double read_xsens_number(const std::uint8_t* p, int precision) {
  switch (precision) {
    case 0:
      return read_big_r4(p);
    case 1:
      return static_cast<std::int32_t>(read_big_u4(p)) * 0x1p-20;
    case 2:
      return static_cast<std::int16_t>(read_big_u2(p + 4)) + read_big_u4(p) * 0x1p-32;
    default:
      return read_big_r8(p);
  }
}

// Reads N numbers that fill `data`; nullopt: it has another length.
template <std::size_t N>
std::optional<std::array<double, N>> read_xsens_numbers(std::span<const std::uint8_t> data,
                                                        int precision) {
  const std::size_t bytes = xsens_number_bytes(precision);
  if (data.size() != N * bytes) return std::nullopt;
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i) {
    numbers[i] = read_xsens_number(data.data() + i * bytes, precision);
  }
  return numbers;
}

}  // namespace leonav
