// Messages of u-blox receivers, put together byte by byte by the interface description.
#pragma once
#include <cstdint>

#include "support/bytes/bytes.h"

namespace leonav::test {

// With its frame and checksum.
inline Bytes message(std::uint8_t message_class, std::uint8_t id, const Bytes& payload) {
  Bytes bytes = {message_class, id};
  put(&bytes, payload.size(), 2);
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  std::uint8_t a = 0, b = 0;
  for (const std::uint8_t byte : bytes) {
    a = static_cast<std::uint8_t>(a + byte);
    b = static_cast<std::uint8_t>(b + a);
  }
  bytes.push_back(a);
  bytes.push_back(b);
  bytes.insert(bytes.begin(), {0xB5, 0x62});
  return bytes;
}

}  // namespace leonav::test
