// This function writes a message of fixed size into an array.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace leonav {

template <std::size_t size, typename Message>
std::array<std::uint8_t, size> bytes_of(const Message& message) {
  std::array<std::uint8_t, size> bytes{};
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

}  // namespace leonav
