// A ByteScript reads numbers off the bytes of an input; behind its end they are zero.
#pragma once
#include <algorithm>
#include <cstdint>

#include "test/fuzz/fuzz_target.h"

namespace leonav::test {

class ByteScript {
 public:
  explicit ByteScript(FuzzBytes bytes) : rest_(bytes) {}

  bool empty() const { return rest_.empty(); }
  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t first = rest_.front();
    rest_ = rest_.subspan(1);
    return first;
  }
  // Two bytes, the low one first.
  std::size_t half() {
    const std::size_t low = byte();
    return low | static_cast<std::size_t>(byte()) << 8;
  }
  FuzzBytes take(std::size_t count) {
    const FuzzBytes taken = rest_.first(std::min(count, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  FuzzBytes rest() { return take(rest_.size()); }

 private:
  FuzzBytes rest_;
};

// A number that follows from the bytes and that they do not show (FNV-1a).
inline std::uint64_t hash_of(FuzzBytes bytes) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001B3;
  return hash ^ hash >> 29;
}

}  // namespace leonav::test
