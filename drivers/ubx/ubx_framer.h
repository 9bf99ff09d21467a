// This unit finds UBX messages in a stream of bytes by sync characters, length bound and Fletcher
// checksum.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/binary/message_framer.h"
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

// How UBX messages begin and end.
struct UbxFraming : MessageFraming {
  // RXM-RAWX with 255 measurements has 16 + 255 * 32 bytes of payload; nothing else is longer.
  static constexpr std::size_t kMaxPayload = 16 + 255 * 32;
  static constexpr std::size_t kOverhead = 8;  // header, checksum 2
  static constexpr std::uint8_t kFirstByte = 0xB5;
  static constexpr std::size_t kMinHeader = 6;  // sync 2, class, id, length 2
  static constexpr std::size_t kCapacity = 2 * (kMaxPayload + kOverhead);

  struct Checksum {
    std::uint8_t sum = 0, sum_of_sums = 0;  // modulo 256, both
  };
  static Checksum continued(Checksum before, std::uint8_t byte);
  static StartClaim claim_of(std::span<const std::uint8_t> bytes);
  static bool checksum_is_good(std::span<const std::uint8_t> message, const Checksum* before);
  void skip(std::span<const std::uint8_t> bytes);

  ForeignMessages foreign;
};
extern template class MessageFramer<UbxFraming>;

class UbxFramer : public MessageFramer<UbxFraming> {
 public:
  // Takes the next message; returns false if more bytes are needed.
  bool next(UbxMessage* message);
  UbxFramerCounters counters() const;
};

}  // namespace leonav
