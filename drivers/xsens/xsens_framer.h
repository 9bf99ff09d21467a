// This unit finds Xsens messages in a stream of bytes by preamble, bus identifier, length and
// checksum.
//
// Source: Xsens, MT Low Level Communication Protocol Documentation (MT0101P), chapter "Message
// structure".
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/binary/message_starts.h"

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

// The caller appends bytes and takes messages until none is left. The checksum has eight bits, so
// that one of 256 false starts has a good one; an MTData2 counts only if its groups of data fill it
// to its last byte. A false start or a damaged message costs only its own bytes, and no time: of
// all starts in the stream the one whose message is whole first counts, if it is good. Only an
// MTData2 counts before an earlier start is known to be none, as eight bits alone prove too little.
class XsensFramer {
 public:
  static constexpr std::uint8_t kMtData2 = 0x36;
  static constexpr std::size_t kMaxShort = 254;     // payload of a message with one byte of length
  static constexpr std::size_t kMaxPayload = 2048;  // of one with three, which only MTData2 has

  // Copies as many of `bytes` as fit and returns their number. It is never zero unless `bytes` is
  // empty or a message has not been taken yet.
  std::size_t append(std::span<const std::uint8_t> bytes);
  // Takes the next message; returns false if more bytes are needed.
  bool next(XsensMessage* message);
  // Ends the stream: a message that is cut off no longer hides those after a false start.
  void finish() { finished_ = true; }
  const XsensFramerCounters& counters() const { return counters_; }

 private:
  static constexpr std::size_t kLongHeader = 6, kShortHeader = 4, kChecksum = 1;
  static constexpr std::size_t kCapacity = 4 * (kLongHeader + kMaxPayload + kChecksum);

  // Why a start is none.
  static constexpr std::size_t kBadChecksum = 1, kBadLength = 2, kBadGroups = 3;
  // Positions are of bytes in the whole stream; buffer_[0] is that of base_.
  using Position = MessageStarts::Position;

  enum class Header : std::uint8_t { kComplete, kIncomplete, kImpossible };
  // The lengths of header and payload of the message that begins at `start`.
  Header read_header(Position start, std::size_t* header, std::size_t* payload) const;
  std::size_t index(Position position) const { return position - base_; }
  void find_starts();
  // MessageStarts::kWaiting: the candidate is good.
  std::size_t fault_of(const MessageStarts::Candidate& candidate) const;
  std::span<const std::uint8_t> payload_of(const MessageStarts::Candidate& candidate) const;
  void take(const MessageStarts::Candidate& candidate, XsensMessage* message);
  void skip_to(Position position);

  std::array<std::uint8_t, kCapacity> buffer_;
  std::array<std::uint8_t, kCapacity> sum_;  // modulo 256, of all bytes up to and with this one
  std::uint8_t last_sum_ = 0;
  Position base_ = 0, begin_ = 0, end_ = 0;  // of the buffer; the first byte kept; behind the last
  Position searched_ = 0;                    // starts before it are known
  MessageStarts starts_;                     // at begin_ and behind it
  bool finished_ = false;
  XsensFramerCounters counters_;
};

}  // namespace leonav
