#include "output_digest.h"

namespace leonav {

void OutputDigest::add(std::size_t group, ByteSpan bytes) {
  // The length first: otherwise two messages and their concatenation would be one.
  std::array<std::uint8_t, 8> length;
  for (std::size_t i = 0; i < 8; ++i) {
    length[i] = static_cast<std::uint8_t>(std::uint64_t{bytes.size()} >> (56 - 8 * i));
  }
  hashes_[group].add(length);
  hashes_[group].add(bytes);
  ++messages_[group];
}

std::string OutputDigest::hex_digest() {
  Sha256 all;
  for (Sha256& hash : hashes_) {
    const std::string hex = hash.hex_digest();
    all.add({reinterpret_cast<const std::uint8_t*>(hex.data()), hex.size()});
  }
  return all.hex_digest();
}

}  // namespace leonav
