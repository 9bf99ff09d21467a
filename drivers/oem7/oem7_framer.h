// This unit finds NovAtel binary messages in a stream of bytes by sync bytes, lengths and CRC-32.
// Source: OEM7 Commands and Logs Reference Manual, chapters "Binary" and "Description of ASCII and
// Binary Logs with Short Headers".
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/gps_time.h"
#include "drivers/binary/message_framer.h"

namespace leonav {

// A framed message with a good checksum; `payload` is valid until the framer is used again.
struct Oem7Message {
  std::uint16_t id = 0;
  std::uint8_t source = 0;   // bits 0 to 4 of the message type; 1: the second antenna
  bool is_response = false;  // to a command, in the form of the log
  GpsTime time;              // of the header; unset while the receiver does not know it
  std::span<const std::uint8_t> payload;
};

// Counts of messages and of bytes between them.
struct Oem7FramerCounters {
  std::uint64_t messages = 0;       // framed, checksum good
  std::uint64_t bytes_skipped = 0;  // outside any message (text, other protocols, damage)
  std::uint64_t text_bytes = 0;     // the part of bytes_skipped that is printable
  std::uint64_t bad_checksums = 0;
  std::uint64_t bad_headers = 0;  // sync, but a length that no message has
  std::uint64_t incomplete = 0;   // cut off by the end of the stream
};

// How NovAtel messages begin and end.
struct Oem7Framing : TextCountingFraming {
  // The longest message of the manuals, RANGE with 325 signals, has 14,304 bytes.
  static constexpr std::size_t kMaxPayload = 16384;
  static constexpr std::size_t kMaxHeader = 64;
  static constexpr std::size_t kChecksum = 4;
  static constexpr std::uint8_t kFirstByte = 0xAA;
  static constexpr std::size_t kMinHeader = 12;  // the short one
  static constexpr std::size_t kCapacity = 2 * (kMaxHeader + kMaxPayload + kChecksum);

  using Checksum = std::uint32_t;
  static Checksum continued(Checksum before, std::uint8_t byte);
  static StartClaim claim_of(std::span<const std::uint8_t> bytes);
  static bool checksum_is_good(std::span<const std::uint8_t> message, const Checksum* before);
};
extern template class MessageFramer<Oem7Framing>;

class Oem7Framer : public MessageFramer<Oem7Framing> {
 public:
  // Takes the next message; returns false if more bytes are needed.
  bool next(Oem7Message* message);
  Oem7FramerCounters counters() const;
};

}  // namespace leonav
