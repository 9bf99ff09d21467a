// This unit finds VectorNav binary messages in a stream of bytes by sync byte, field masks and
// checksum.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/vectornav/field_layout.h"

namespace leonav {

// A message with a good checksum; `bytes` is valid until the framer is used again.
struct VectornavMessage {
  std::span<const std::uint8_t> bytes;  // sync byte to checksum
  VectornavExtent extent;
};

// Counts of messages and of bytes between them.
struct VectornavFramerCounters {
  std::uint64_t messages = 0;        // framed, checksum good
  std::uint64_t bytes_skipped = 0;   // outside any message (ASCII messages, damage)
  std::uint64_t bad_checksums = 0;   // a sync byte that no good message follows
  std::uint64_t unknown_fields = 0;  // a sync byte, then a field of unknown length: often no sync
  std::uint64_t incomplete = 0;      // cut off by the end of the stream
};

// The caller appends bytes and takes messages until none is left. A false sync or a damaged message
// costs only its own bytes: the search resumes one byte after its first.
class VectornavFramer {
 public:
  VectornavFramer();

  // Copies as many of `bytes` as fit and returns their number. It is never zero unless `bytes` is
  // empty or a message has not been taken yet.
  std::size_t append(std::span<const std::uint8_t> bytes);
  // Takes the next message; returns false if more bytes are needed.
  bool next(VectornavMessage* message);
  // Ends the stream: a message that is cut off no longer hides those after a false sync.
  void finish() { finished_ = true; }
  const VectornavFramerCounters& counters() const { return counters_; }

 private:
  static constexpr std::size_t kCapacity = 4 * kMaxVectornavMessage;

  void skip(std::size_t count);
  void skip_to_sync();
  bool checksum_is_good(std::size_t first, std::size_t count) const;

  std::array<std::uint8_t, kCapacity> buffer_;
  std::array<std::uint16_t, kCapacity> crc_;  // of all bytes up to and including this one
  // x^(8 n) modulo the checksum's polynomial, for a message of n bytes.
  std::array<std::uint16_t, kMaxVectornavMessage + 1> power_;
  std::uint16_t last_crc_ = 0;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  bool finished_ = false;
  VectornavFramerCounters counters_;
};

}  // namespace leonav
