// This unit finds VectorNav binary messages in a stream of bytes by sync byte, field masks and
// checksum.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/binary/message_starts.h"
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
// costs only its own bytes, and no time: of all starts in the stream the one whose message is whole
// first, with a good checksum, counts, so that damaged masks hold nothing back that comes behind
// them. But a start whose header is that of one of the last messages is awaited to its end before
// those inside it: of the 65,536 values of a checksum one is right by chance. Every byte costs the
// same, whatever the masks claim.
class VectornavFramer {
 public:
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

  // Why a start is none.
  static constexpr std::size_t kBadChecksum = 1, kUnknownField = 2, kCutOff = 3;
  // Positions are of bytes in the whole stream; buffer_[0] is that of base_.
  using Position = MessageStarts::Position;

  std::size_t index(Position position) const { return position - base_; }
  VectornavHeader read_header(Position start, VectornavExtent* extent) const;
  void find_starts();
  std::optional<MessageStarts::Candidate> next_candidate();
  bool has_known_header(Position start) const;
  void remember_header(Position start, std::size_t size);
  bool checksum_is_good(const MessageStarts::Candidate& candidate) const;
  void take(const MessageStarts::Candidate& candidate, VectornavMessage* message);
  void skip_to(Position position);

  std::array<std::uint8_t, kCapacity> buffer_;
  // Checksum of all bytes of the stream before this one; one entry more, for the end.
  std::array<std::uint16_t, kCapacity + 1> crc_before_{};
  Position base_ = 0, begin_ = 0, end_ = 0;  // of the buffer; the first byte kept; behind the last
  Position searched_ = 0;                    // starts before it are known
  MessageStarts starts_;                     // at begin_ and behind it
  bool finished_ = false;
  // Headers of the last messages, one of each kind; size 0: none. A sensor has three outputs.
  struct Header {
    std::array<std::uint8_t, kMaxVectornavHeader> bytes;
    std::size_t size = 0;
  };
  std::array<Header, 3> known_headers_;
  std::size_t oldest_header_ = 0;
  VectornavFramerCounters counters_;
};

}  // namespace leonav
