// This unit finds UBX messages in a stream of bytes by sync characters, length bound and Fletcher
// checksum.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/binary/message_starts.h"
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
  std::uint64_t bad_checksums = 0;  // a start that no good message follows
  std::uint64_t oversize = 0;       // claimed length above kMaxPayload: taken for a false sync
  std::uint64_t incomplete = 0;     // cut off by the end of the stream
};

// The caller appends bytes and takes messages until none is left. A false sync or a damaged message
// costs only its own bytes, and no time: of all starts in the stream the one whose message is whole
// first, with a good checksum, counts, so that a false start with a great length holds nothing back
// that comes behind it. Starts within a message that counts, or before it, are none.
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
  static constexpr std::size_t kHeader = 6;    // sync 2, class, id, length 2
  static constexpr std::size_t kOverhead = 8;  // header, checksum 2
  static constexpr std::size_t kCapacity = 2 * (kMaxPayload + kOverhead);

  // Why a start is none.
  static constexpr std::size_t kBadChecksum = 1, kOversize = 2;
  // Positions are of bytes in the whole stream; buffer_[0] is that of base_.
  using Position = MessageStarts::Position;

  void find_starts();
  void skip_to(Position position);
  void skip_what_is_none();
  void take(Position start, Position end, UbxMessage* message);
  bool checksum_is_good(Position start, Position end) const;
  std::uint8_t at(Position position) const { return buffer_[position - base_]; }

  std::array<std::uint8_t, kCapacity> buffer_;
  std::array<std::uint8_t, kCapacity> sum_;          // of all bytes up to and including this one
  std::array<std::uint8_t, kCapacity> sum_of_sums_;  // modulo 256, both
  std::uint8_t last_sum_ = 0;
  std::uint8_t last_sum_of_sums_ = 0;
  Position base_ = 0, begin_ = 0, end_ = 0;  // of the buffer; the first byte kept; behind the last
  Position searched_ = 0;                    // starts before it are known
  MessageStarts starts_;                     // at begin_ and behind it
  bool finished_ = false;
  UbxFramerCounters counters_;
  ForeignMessages foreign_;
};

}  // namespace leonav
