// One hash for all outputs of a run, whatever the order in which threads gave them.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "daemon/output_groups.h"
#include "sha256.h"

namespace leonav {

class OutputDigest {
 public:
  void add(std::size_t group, ByteSpan bytes);
  // SHA-256 over the groups' own SHA-256 in the order of kOutputGroups. Ends the digest.
  std::string hex_digest();
  std::uint64_t messages(std::size_t group) const { return messages_[group]; }

 private:
  std::array<Sha256, kOutputGroups.size()> hashes_;
  std::array<std::uint64_t, kOutputGroups.size()> messages_{};
};

}  // namespace leonav
