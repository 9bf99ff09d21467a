// This unit finds SBF blocks in a stream of bytes by sync bytes, length and CRC-16. Source:
// mosaic-X5 Reference Guide, "SBF Outline".
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/gps_time.h"
#include "drivers/binary/message_starts.h"

namespace leonav {

// A framed block with a good checksum; `payload` is valid until the framer is used again.
struct SbfBlock {
  std::uint16_t number = 0;  // 13 bits, without the revision
  GpsTime time;              // its time stamp; unset while the receiver does not know it
  std::span<const std::uint8_t> payload;  // behind the time stamp, with the padding at its end
};

// Counts of blocks and of bytes between them.
struct SbfFramerCounters {
  std::uint64_t blocks = 0;         // framed, checksum good
  std::uint64_t bytes_skipped = 0;  // outside any block (NMEA, command replies, damage)
  std::uint64_t text_bytes = 0;     // the part of bytes_skipped that is printable
  std::uint64_t bad_checksums = 0;  // a start that no good block follows
  std::uint64_t bad_lengths = 0;    // sync, but a length that no block has
  std::uint64_t incomplete = 0;     // cut off by the end of the stream
};

// The caller appends bytes and takes blocks until none is left. A false sync or a damaged block
// costs only its own bytes, and no time: of all starts in the stream the one whose block is whole
// first, with a good checksum, counts, so that a damaged length holds nothing back that comes
// behind it. Every byte costs the same, whatever lengths the stream claims.
class SbfFramer {
 public:
  // A MeasEpoch with 100 satellites of five signals each has 6,820 bytes. The length field can
  // claim 65,532; a longer block than this one is no block of interest.
  static constexpr std::size_t kMaxSize = 16384;

  // Copies as many of `bytes` as fit and returns their number. It is never zero unless `bytes` is
  // empty or a block has not been taken yet.
  std::size_t append(std::span<const std::uint8_t> bytes);
  // Takes the next block; returns false if more bytes are needed.
  bool next(SbfBlock* block);
  // Ends the stream: what is left counts as skipped after a search for blocks inside it. After it,
  // call next() until it returns false.
  void finish() { finished_ = true; }

  const SbfFramerCounters& counters() const { return counters_; }

 private:
  static constexpr std::size_t kCapacity = 2 * kMaxSize;
  // Why a start is none.
  static constexpr std::size_t kBadChecksum = 1, kBadLength = 2;
  // Positions are of bytes in the whole stream; buffer_[0] is that of base_.
  using Position = MessageStarts::Position;

  std::size_t index(Position position) const { return position - base_; }
  void find_starts();
  bool checksum_is_good(const MessageStarts::Candidate& candidate) const;
  void take(const MessageStarts::Candidate& candidate, SbfBlock* block);
  void skip_to(Position position);

  std::array<std::uint8_t, kCapacity> buffer_;
  // Checksum of all bytes of the stream before this one; one entry more, for the end.
  std::array<std::uint16_t, kCapacity + 1> crc_before_{};
  Position base_ = 0, begin_ = 0, end_ = 0;  // of the buffer; the first byte kept; behind the last
  Position searched_ = 0;                    // starts before it are known
  MessageStarts starts_;                     // at begin_ and behind it
  bool finished_ = false;
  SbfFramerCounters counters_;
};

}  // namespace leonav
