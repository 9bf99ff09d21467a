// This unit finds NovAtel binary messages in a stream of bytes by sync bytes, lengths and CRC-32.
// Source: OEM7 Commands and Logs Reference Manual, chapters "Binary" and "Description of ASCII and
// Binary Logs with Short Headers".
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/gps_time.h"
#include "drivers/binary/message_starts.h"

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

// The caller appends bytes and takes messages until none is left. A false sync or a damaged message
// costs only its own bytes, and no time: of all starts in the stream the one whose message is whole
// first, with a good checksum, counts, so that a damaged length holds nothing back that comes
// behind it. Every byte costs the same, whatever lengths the stream claims.
class Oem7Framer {
 public:
  // The longest message of the manuals, RANGE with 325 signals, has 14,304 bytes.
  static constexpr std::size_t kMaxPayload = 16384;

  // Copies as many of `bytes` as fit and returns their number. It is never zero unless `bytes` is
  // empty or a message has not been taken yet.
  std::size_t append(std::span<const std::uint8_t> bytes);
  // Takes the next message; returns false if more bytes are needed.
  bool next(Oem7Message* message);
  // Ends the stream: what is left counts as skipped after a search for messages inside it. After
  // it, call next() until it returns false.
  void finish() { finished_ = true; }

  const Oem7FramerCounters& counters() const { return counters_; }

 private:
  static constexpr std::size_t kMaxHeader = 64;
  static constexpr std::size_t kChecksum = 4;
  static constexpr std::size_t kMaxSize = kMaxHeader + kMaxPayload + kChecksum;
  static constexpr std::size_t kCapacity = 2 * kMaxSize;

  // Why a start is none.
  static constexpr std::size_t kBadChecksum = 1, kBadHeader = 2;
  // Positions are of bytes in the whole stream; buffer_[0] is that of base_.
  using Position = MessageStarts::Position;

  // Sizes that a header states.
  struct Layout {
    std::size_t header = 0, payload = 0;
    std::size_t size() const { return header + payload + kChecksum; }
  };

  std::size_t index(Position position) const { return position - base_; }
  bool is_sync(Position start) const;
  bool read_layout(Position start, Layout* layout) const;
  void find_starts();
  bool checksum_is_good(const MessageStarts::Candidate& candidate) const;
  void take(const MessageStarts::Candidate& candidate, Oem7Message* message);
  void skip_to(Position position);

  std::array<std::uint8_t, kCapacity> buffer_;
  // Checksum of all bytes of the stream before this one; one entry more, for the end.
  std::array<std::uint32_t, kCapacity + 1> crc_before_{};
  Position base_ = 0, begin_ = 0, end_ = 0;  // of the buffer; the first byte kept; behind the last
  Position searched_ = 0;                    // starts before it are known
  MessageStarts starts_;                     // at begin_ and behind it
  bool finished_ = false;
  Oem7FramerCounters counters_;
};

}  // namespace leonav
