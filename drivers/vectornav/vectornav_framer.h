// This unit finds VectorNav binary messages in a stream of bytes by sync byte, field masks and
// checksum.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/binary/message_framer.h"
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

// How VectorNav messages begin and end. A start whose header is that of one of the last messages is
// awaited to its end before those inside it: of the 65,536 values of a checksum one is right by
// chance.
struct VectornavFraming : MessageFraming {
  static constexpr std::uint8_t kFirstByte = 0xFA;
  static constexpr std::size_t kMinHeader = 1;
  static constexpr std::size_t kCapacity = 4 * kMaxVectornavMessage;

  using Checksum = std::uint16_t;
  static Checksum continued(Checksum before, std::uint8_t byte);
  static StartClaim claim_of(std::span<const std::uint8_t> bytes);
  static bool checksum_is_good(std::span<const std::uint8_t> message, const Checksum* before);
  bool is_awaited(std::span<const std::uint8_t> bytes) const;
  void remember(std::span<const std::uint8_t> header);

 private:
  // Headers of the last messages, one of each kind; size 0: none. A sensor has three outputs.
  struct Header {
    std::array<std::uint8_t, kMaxVectornavHeader> bytes;
    std::size_t size = 0;
  };
  std::array<Header, 3> known_headers_;
  std::size_t oldest_header_ = 0;
};
extern template class MessageFramer<VectornavFraming>;

class VectornavFramer : public MessageFramer<VectornavFraming> {
 public:
  // Takes the next message; returns false if more bytes are needed.
  bool next(VectornavMessage* message);
  VectornavFramerCounters counters() const;
};

}  // namespace leonav
