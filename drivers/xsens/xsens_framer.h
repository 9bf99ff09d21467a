// This unit finds Xsens messages in a stream of bytes by preamble, bus identifier, length and
// checksum.
//
// Source: Xsens, MT Low Level Communication Protocol Documentation (MT0101P), chapter "Message
// structure".
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/binary/message_framer.h"

namespace leonav {

// A message with a good checksum; `payload` is valid until the framer is used again.
struct XsensMessage {
  std::uint8_t id = 0;
  std::span<const std::uint8_t> payload;
};

// Counts of messages and of bytes between them.
struct XsensFramerCounters {
  std::uint64_t messages = 0;       // framed, checksum good
  std::uint64_t bytes_skipped = 0;  // outside any message
  std::uint64_t bad_checksums = 0;  // a start that no good message follows
  std::uint64_t bad_lengths = 0;    // a preamble, then a bus or a length that no message has
  std::uint64_t bad_groups = 0;     // an MTData2 whose groups do not fill it: by chance no message
  std::uint64_t incomplete = 0;     // cut off by the end of the stream
};

// How Xsens messages begin and end. The checksum has eight bits, so that one of 256 false starts
// has a good one; an MTData2 counts only if its groups of data fill it to its last byte. Only an
// MTData2 counts before an earlier start is known to be none, as eight bits alone prove too little.
struct XsensFraming : MessageFraming {
  static constexpr std::uint8_t kMtData2 = 0x36;
  static constexpr std::size_t kMaxShort = 254;     // payload of a message with one byte of length
  static constexpr std::size_t kMaxPayload = 2048;  // of one with three, which only MTData2 has
  static constexpr std::size_t kLongHeader = 6, kShortHeader = 4, kChecksum = 1;
  static constexpr std::uint8_t kFirstByte = 0xFA;
  static constexpr std::size_t kMinHeader = 1;
  static constexpr std::size_t kCapacity = 4 * (kLongHeader + kMaxPayload + kChecksum);

  using Checksum = std::uint8_t;
  static Checksum continued(Checksum before, std::uint8_t byte);
  static StartClaim claim_of(std::span<const std::uint8_t> bytes);
  static bool checksum_is_good(std::span<const std::uint8_t> message, const Checksum* before);
  static MessageStarts::Reason fault_of(std::span<const std::uint8_t> message, bool is_first);
};
extern template class MessageFramer<XsensFraming>;

class XsensFramer : public MessageFramer<XsensFraming> {
 public:
  // Takes the next message; returns false if more bytes are needed.
  bool next(XsensMessage* message);
  XsensFramerCounters counters() const;
};

}  // namespace leonav
