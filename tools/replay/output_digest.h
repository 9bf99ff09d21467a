// OutputDigest computes one hash of all outputs of a run, independent of the interleaving of
// threads.
#pragma once
#include <array>
#include <boost/crc.hpp>
#include <cstdint>
#include <string>

#include "daemon/messages/output_groups.h"

namespace leonav {

// CRC-64 of ECMA-182 (DLT1 tape cartridges), most significant bit first, no reflection. It
// distinguishes runs that differ by accident; it gives no protection against forgery.
using Crc64 = boost::crc_optimal<64, 0x42F0E1EBA9EA3693, 0, 0, false, false>;

// OutputDigest keeps one sum per output group (daemon/messages/output_groups.h).
class OutputDigest {
 public:
  void add(std::size_t group, ByteSpan bytes);
  // Returns the CRC-64 over each group's count and CRC-64, big endian, in the order of
  // kOutputGroups, as 16 hexadecimal digits.
  std::string hex_digest() const;
  std::uint64_t messages(std::size_t group) const { return messages_[group]; }

 private:
  std::array<Crc64, kOutputGroups.size()> sums_;
  std::array<std::uint64_t, kOutputGroups.size()> messages_{};
};

}  // namespace leonav
