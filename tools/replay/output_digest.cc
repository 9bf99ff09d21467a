#include "tools/replay/output_digest.h"

#include <cinttypes>
#include <cstdio>

namespace leonav {
namespace {

// The number is added byte by byte, so that the sum is the same on every machine.
void add_number(std::uint64_t number, Crc64* sum) {
  for (int shift = 56; shift >= 0; shift -= 8) {
    sum->process_byte(static_cast<std::uint8_t>(number >> shift));
  }
}

}  // namespace

void OutputDigest::add(std::size_t group, ByteSpan bytes) {
  // The length comes first; otherwise two messages and their concatenation would give one sum.
  add_number(bytes.size(), &sums_[group]);
  sums_[group].process_bytes(bytes.data(), bytes.size());
  ++messages_[group];
}

std::string OutputDigest::hex_digest() const {
  Crc64 all;
  for (std::size_t group = 0; group < sums_.size(); ++group) {
    add_number(messages_[group], &all);
    add_number(sums_[group].checksum(), &all);
  }
  std::array<char, 17> text;
  std::snprintf(text.data(), text.size(), "%016" PRIx64, std::uint64_t{all.checksum()});
  return text.data();
}

}  // namespace leonav
