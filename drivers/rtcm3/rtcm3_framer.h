// This unit finds RTCM 3 frames in a stream of bytes by preamble, reserved bits, length and
// CRC-24Q. Source: RTCM 10403.3, 4.1 and 4.2.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/binary/message_framer.h"

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

// How RTCM 3 frames begin and end.
struct Rtcm3Framing : MessageFraming {
  static constexpr std::size_t kMaxMessage = 1023;  // the length has ten bits
  static constexpr std::size_t kChecksum = 3;
  static constexpr std::uint8_t kFirstByte = 0xD3;
  static constexpr std::size_t kMinHeader = 3;  // preamble 8 bits, reserved 6, length 10
  static constexpr std::size_t kCapacity = 4 * (kMinHeader + kMaxMessage + kChecksum);

  using Checksum = std::uint32_t;
  static Checksum continued(Checksum before, std::uint8_t byte);
  static StartClaim claim_of(std::span<const std::uint8_t> bytes);
  static bool checksum_is_good(std::span<const std::uint8_t> frame, const Checksum* before);
};
extern template class MessageFramer<Rtcm3Framing>;

class Rtcm3Framer : public MessageFramer<Rtcm3Framing> {
 public:
  // Takes the next frame that holds a message; returns false if more bytes are needed.
  bool next(Rtcm3Frame* frame);
  Rtcm3FramerCounters counters() const;

 private:
  std::uint64_t too_short_ = 0;
};

}  // namespace leonav
