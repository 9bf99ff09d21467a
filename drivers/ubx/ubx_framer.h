// This unit finds UBX messages in a stream of bytes by sync characters, length bound and Fletcher
// checksum.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/ubx/foreign_messages.h"

namespace leonav {

// A framed message with a good checksum; `payload` is valid until the framer is used again.
struct UbxMessage {
  std::uint8_t message_class = 0;
  std::uint8_t id = 0;
  std::span<const std::uint8_t> payload;
};

// Counts of messages and of bytes between them.
struct UbxFramerCounters {
  std::uint64_t messages = 0;       // framed, checksum good
  std::uint64_t bytes_skipped = 0;  // outside any message (other protocols, damage)
  ForeignMessageCounters foreign;   // the part of bytes_skipped that belongs to other protocols
  std::uint64_t bad_checksums = 0;
  std::uint64_t oversize = 0;    // claimed length above kMaxPayload: taken for a false sync
  std::uint64_t incomplete = 0;  // cut off by the end of the stream
};

// The caller appends bytes and takes messages until none is left. A false sync or a damaged message
// costs only its own bytes: the search resumes one byte after its first.
class UbxFramer {
 public:
  // RXM-RAWX with 255 measurements has 16 + 255 * 32 bytes of payload; nothing else is longer.
  static constexpr std::size_t kMaxPayload = 16 + 255 * 32;

  // Copies as many of `bytes` as fit and returns their number. It is never zero unless `bytes` is
  // empty or a message has not been taken yet.
  std::size_t append(std::span<const std::uint8_t> bytes);
  // Takes the next message; returns false if more bytes are needed.
  bool next(UbxMessage* message);
  // Ends the stream: the rest counts as skipped after a search for messages inside it (a false sync
  // near the end must not hide good messages). After it, call next() until it returns false.
  void finish() { finished_ = true; }

  UbxFramerCounters counters() const;

 private:
  static constexpr std::size_t kOverhead = 8;  // sync 2, class, id, length 2, checksum 2
  static constexpr std::size_t kCapacity = 2 * (kMaxPayload + kOverhead);

  void skip(std::size_t count);
  void skip_to_sync();
  bool checksum_is_good(std::size_t first, std::size_t last) const;

  std::array<std::uint8_t, kCapacity> buffer_;
  std::array<std::uint8_t, kCapacity> sum_;          // of all bytes up to and including this one
  std::array<std::uint8_t, kCapacity> sum_of_sums_;  // modulo 256, both
  std::uint8_t last_sum_ = 0;
  std::uint8_t last_sum_of_sums_ = 0;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  bool finished_ = false;
  UbxFramerCounters counters_;
  ForeignMessages foreign_;
};

}  // namespace leonav
