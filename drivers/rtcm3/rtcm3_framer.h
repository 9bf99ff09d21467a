// This unit finds RTCM 3 frames in a stream of bytes by preamble, reserved bits, length and
// CRC-24Q. Source: RTCM 10403.3, 4.1 and 4.2.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/binary/message_starts.h"

namespace leonav {

// A frame with a good checksum; `message` is valid until the framer is used again.
struct Rtcm3Frame {
  std::uint16_t type = 0;                 // DF002, the message number; 0 of an empty frame
  std::span<const std::uint8_t> message;  // from its number on, without preamble and checksum
};

// Counts of frames and of bytes between them.
struct Rtcm3FramerCounters {
  std::uint64_t frames = 0;         // framed, checksum good
  std::uint64_t bytes_skipped = 0;  // outside any frame (other protocols, damage)
  std::uint64_t bad_checksums = 0;  // preamble and reserved bits good, checksum not
  std::uint64_t incomplete = 0;     // cut off by the end of the stream
  std::uint64_t too_short = 0;      // good frame without room for a message number
};

// The caller appends bytes and takes frames until none is left. A false preamble or a damaged frame
// costs only its own bytes, and no time: of all starts in the stream the one whose frame is whole
// first, with a good checksum, counts, so that a damaged length holds nothing back that comes
// behind it. Every byte costs the same, whatever lengths the stream claims.
class Rtcm3Framer {
 public:
  static constexpr std::size_t kMaxMessage = 1023;  // the length has ten bits

  // Copies as many of `bytes` as fit and returns their number. It is never zero unless `bytes` is
  // empty or a frame has not been taken yet.
  std::size_t append(std::span<const std::uint8_t> bytes);
  // Takes the next frame; returns false if more bytes are needed.
  bool next(Rtcm3Frame* frame);
  // Ends the stream: what is left counts as skipped after a search for frames inside it. After it,
  // call next() until it returns false.
  void finish() { finished_ = true; }

  const Rtcm3FramerCounters& counters() const { return counters_; }

 private:
  static constexpr std::size_t kHeader = 3;  // preamble 8 bits, reserved 6, length 10
  static constexpr std::size_t kChecksum = 3;
  static constexpr std::size_t kMaxFrame = kHeader + kMaxMessage + kChecksum;
  static constexpr std::size_t kCapacity = 4 * kMaxFrame;

  // Why a start is none.
  static constexpr std::size_t kBadChecksum = 1;
  // Positions are of bytes in the whole stream; buffer_[0] is that of base_.
  using Position = MessageStarts::Position;

  std::size_t index(Position position) const { return position - base_; }
  void find_starts();
  bool checksum_is_good(const MessageStarts::Candidate& candidate) const;
  // Whether the frame holds a message; one that holds none is filling.
  bool take(const MessageStarts::Candidate& candidate, Rtcm3Frame* frame);
  void skip_to(Position position);

  std::array<std::uint8_t, kCapacity> buffer_;
  // Checksum of all bytes of the stream before this one; one entry more, for the end.
  std::array<std::uint32_t, kCapacity + 1> crc_before_{};
  Position base_ = 0, begin_ = 0, end_ = 0;  // of the buffer; the first byte kept; behind the last
  Position searched_ = 0;                    // starts before it are known
  MessageStarts starts_;                     // at begin_ and behind it
  bool finished_ = false;
  Rtcm3FramerCounters counters_;
};

}  // namespace leonav
