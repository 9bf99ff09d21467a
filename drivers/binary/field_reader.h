// This header takes little-endian fields of a binary message one after the other.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/binary/little_endian.h"

namespace leonav {

// Precondition of every function: the fields taken lie within the payload, whose length the caller
// has checked.
class FieldReader {
 public:
  explicit FieldReader(std::span<const std::uint8_t> payload) : next_(payload.data()) {}

  std::uint8_t byte() { return *step(1); }
  std::uint16_t half() { return read_u2(step(2)); }
  std::uint32_t number() { return read_u4(step(4)); }
  float single() { return read_r4(step(4)); }
  double real() { return read_r8(step(8)); }
  void skip(std::size_t count) { next_ += count; }

 private:
  const std::uint8_t* step(std::size_t count) {
    const std::uint8_t* here = next_;
    next_ += count;
    return here;
  }
  const std::uint8_t* next_;
};

}  // namespace leonav
