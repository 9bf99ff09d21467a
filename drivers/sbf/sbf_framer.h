// This unit finds SBF blocks in a stream of bytes by sync bytes, length and CRC-16. Source:
// mosaic-X5 Reference Guide, "SBF Outline".
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/gps_time.h"
#include "drivers/binary/message_framer.h"

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

// How SBF blocks begin and end.
struct SbfFraming : TextCountingFraming {
  // A MeasEpoch with 100 satellites of five signals each has 6,820 bytes. The length field can
  // claim 65,532; a longer block than this one is no block of interest.
  static constexpr std::size_t kMaxSize = 16384;
  static constexpr std::uint8_t kFirstByte = '$';
  static constexpr std::size_t kMinHeader = 8;  // sync 2, checksum 2, number 2, length 2
  static constexpr std::size_t kCapacity = 2 * kMaxSize;

  using Checksum = std::uint16_t;
  static Checksum continued(Checksum before, std::uint8_t byte);
  static StartClaim claim_of(std::span<const std::uint8_t> bytes);
  static bool checksum_is_good(std::span<const std::uint8_t> block, const Checksum* before);
};
extern template class MessageFramer<SbfFraming>;

class SbfFramer : public MessageFramer<SbfFraming> {
 public:
  // Takes the next block; returns false if more bytes are needed.
  bool next(SbfBlock* block);
  SbfFramerCounters counters() const;
};

}  // namespace leonav
