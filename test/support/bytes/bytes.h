// Bytes put together one after the other.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace leonav::test {

using Bytes = std::vector<std::uint8_t>;

// Appends `count` bytes of a value, the lowest first.
inline void put(Bytes* bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes->push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

inline Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace leonav::test
