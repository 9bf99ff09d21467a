// This unit finds the messages of a binary format in a stream of bytes. The format says how a start
// looks, how long its message is and whether its checksum is good; the rest is the same for all.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/binary/message_starts.h"

namespace leonav {

// What the bytes from a first byte on say of the message that may begin there.
struct StartClaim {
  enum Kind : std::uint8_t {
    kNone,        // no start
    kIncomplete,  // more bytes are needed
    kImpossible,  // a start, but a length or a field that no message has
    kMessage
  };
  Kind kind = kNone;
  std::size_t size = 0;  // of the whole message; only of kMessage
};

// Counts of messages, of bytes between them, and of starts that no message follows.
struct MessageFramerCounts {
  std::uint64_t messages = 0;       // framed, checksum good
  std::uint64_t bytes_skipped = 0;  // outside any message (other protocols, damage)
  std::uint64_t bad_checksums = 0;
  std::uint64_t impossible = 0;   // a length or a field that no message has
  std::uint64_t bad_content = 0;  // checksum good by chance
  std::uint64_t incomplete = 0;   // cut off by the end of the stream, behind the header
  std::uint64_t cut_headers = 0;  // cut off by the end of the stream, within the header
};

// What most formats have in common. A format is derived from it and adds:
//
//   kFirstByte    the first byte of each message
//   kMinHeader    bytes from there on that claim_of() needs at least
//   kCapacity     bytes to keep, at least two messages of the greatest size
//   Checksum      of all bytes of the stream so far; continued(checksum, byte) adds one
//   claim_of(bytes)                     bytes from a first byte on, to the last one received
//   checksum_is_good(message, before)   before[i]: checksum of the stream before byte i of the
//                                       message; before[message.size()]: behind it
struct MessageFraming {
  // Why a message with a good checksum is none all the same; kWaiting: it is one. `is_first`: no
  // start before it waits.
  static MessageStarts::Reason fault_of(std::span<const std::uint8_t>, bool /*is_first*/) {
    return MessageStarts::kWaiting;
  }
  // Whether the first start that waits is awaited to its end before any behind it is tested.
  static bool is_awaited(std::span<const std::uint8_t>) { return false; }
  // Takes bytes that belong to no message.
  static void skip(std::span<const std::uint8_t>) {}
};

// What formats of receivers have that send text between their messages.
struct TextCountingFraming : MessageFraming {
  void skip(std::span<const std::uint8_t> bytes) {
    text_bytes +=
        static_cast<std::uint64_t>(std::count_if(bytes.begin(), bytes.end(), [](std::uint8_t byte) {
          return (byte >= 0x20 && byte < 0x7F) || byte == '\r' || byte == '\n' || byte == '\t';
        }));
  }
  std::uint64_t text_bytes = 0;  // printable, and no part of a message
};

// The caller appends bytes and takes messages until none is left. A false start or a damaged
// message costs only its own bytes, and no time: of all starts in the stream the one whose message
// is whole first, with a good checksum, counts, so that a damaged length holds nothing back that
// comes behind it. Starts within a message that counts, or before it, are none. Every byte costs
// the same, whatever lengths the stream claims.
template <typename Framing>
class MessageFramer {
 public:
  // Copies as many of `bytes` as fit and returns their number. It is never zero unless `bytes` is
  // empty or a message has not been taken yet.
  std::size_t append(std::span<const std::uint8_t> bytes);
  // Ends the stream: what is left counts as skipped after a search for messages inside it. After
  // it, take messages until none is left.
  void finish() { finished_ = true; }

 protected:
  using Bytes = std::span<const std::uint8_t>;

  // Takes the next message, which is valid until the framer is used again. Empty: more bytes are
  // needed.
  Bytes take_message();
  const MessageFramerCounts& counts() const { return counts_; }
  Framing& framing() { return framing_; }
  const Framing& framing() const { return framing_; }

 private:
  using Position = MessageStarts::Position;

  std::size_t index(Position position) const { return position - base_; }
  Bytes between(Position first, Position end) const {
    return Bytes(buffer_).subspan(index(first), end - first);
  }
  void find_starts();
  void add_start(const StartClaim& claim);
  std::optional<MessageStarts::Candidate> next_candidate();
  MessageStarts::Reason fault_of(const MessageStarts::Candidate& candidate);
  void skip_to(Position position);

  Framing framing_;
  std::array<std::uint8_t, Framing::kCapacity> buffer_;
  // Checksum of all bytes of the stream before this one; one entry more, for the end.
  std::array<typename Framing::Checksum, Framing::kCapacity + 1> before_{};
  // Positions are of bytes in the whole stream; buffer_[0] is that of base_.
  Position base_ = 0, begin_ = 0, end_ = 0;  // of the buffer; the first byte kept; behind the last
  Position searched_ = 0;                    // starts before it are known
  MessageStarts starts_;                     // at begin_ and behind it
  bool finished_ = false;
  MessageFramerCounts counts_;
};

template <typename Framing>
std::size_t MessageFramer<Framing>::append(std::span<const std::uint8_t> bytes) {
  if (begin_ > base_ && index(end_) + bytes.size() > buffer_.size()) {
    const std::size_t first = index(begin_), kept = end_ - begin_;
    std::copy_n(buffer_.begin() + first, kept, buffer_.begin());
    std::copy_n(before_.begin() + first, kept + 1, before_.begin());
    base_ = begin_;
  }
  const std::size_t count = std::min(bytes.size(), buffer_.size() - index(end_));
  for (const std::uint8_t byte : bytes.first(count)) {
    const std::size_t at = index(end_++);
    buffer_[at] = byte;
    before_[at + 1] = Framing::continued(before_[at], byte);
  }
  return count;
}

template <typename Framing>
void MessageFramer<Framing>::find_starts() {
  for (; searched_ + Framing::kMinHeader <= end_; ++searched_) {
    const Bytes sought = between(searched_, end_ - Framing::kMinHeader + 1);
    searched_ += static_cast<Position>(
        std::find(sought.begin(), sought.end(), Framing::kFirstByte) - sought.begin());
    if (searched_ + Framing::kMinHeader > end_) return;
    const StartClaim claim = framing_.claim_of(between(searched_, end_));
    if (claim.kind == StartClaim::kIncomplete && !finished_) return;
    add_start(claim);
  }
}

template <typename Framing>
void MessageFramer<Framing>::add_start(const StartClaim& claim) {
  switch (claim.kind) {
    case StartClaim::kNone:
      return;
    case StartClaim::kIncomplete:
      return starts_.add_refused(searched_, MessageStarts::kCutHeader);
    case StartClaim::kImpossible:
      return starts_.add_refused(searched_, MessageStarts::kImpossible);
    case StartClaim::kMessage:
      return starts_.add(searched_, searched_ + claim.size);
  }
}

template <typename Framing>
std::optional<MessageStarts::Candidate> MessageFramer<Framing>::next_candidate() {
  if (const Bytes bytes = between(begin_, end_); framing_.is_awaited(bytes)) {
    const Position end = begin_ + framing_.claim_of(bytes).size;
    if (end <= end_) return MessageStarts::Candidate{begin_, end};
    if (!finished_) return std::nullopt;
  }
  return starts_.next_whole(end_);
}

template <typename Framing>
MessageStarts::Reason MessageFramer<Framing>::fault_of(const MessageStarts::Candidate& candidate) {
  const Bytes message = between(candidate.start, candidate.end);
  if (!framing_.checksum_is_good(message, before_.data() + index(candidate.start)))
    return MessageStarts::kBadChecksum;
  return framing_.fault_of(message, candidate.start == begin_);
}

template <typename Framing>
typename MessageFramer<Framing>::Bytes MessageFramer<Framing>::take_message() {
  find_starts();
  while (const auto first = starts_.first_waiting()) {
    skip_to(*first);  // bytes before the first start that still waits belong to no message
    const auto candidate = next_candidate();
    if (!candidate) break;
    const MessageStarts::Reason fault = fault_of(*candidate);
    if (fault != MessageStarts::kWaiting) {
      starts_.refuse(*candidate, fault);
      continue;
    }
    skip_to(candidate->start);
    starts_.drop_before(candidate->end);
    begin_ = candidate->end;
    searched_ = std::max(searched_, begin_);
    ++counts_.messages;
    return between(candidate->start, candidate->end);
  }
  skip_to(finished_ ? end_ : starts_.first_waiting().value_or(std::max(searched_, begin_)));
  return {};
}

template <typename Framing>
void MessageFramer<Framing>::skip_to(Position position) {
  const MessageStarts::Counts none = starts_.drop_before(position);
  (finished_ ? counts_.incomplete : counts_.bad_checksums) += none[MessageStarts::kWaiting];
  counts_.bad_checksums += none[MessageStarts::kBadChecksum];
  counts_.impossible += none[MessageStarts::kImpossible];
  counts_.bad_content += none[MessageStarts::kBadContent];
  counts_.cut_headers += none[MessageStarts::kCutHeader];
  const Bytes skipped = between(begin_, position);
  counts_.bytes_skipped += skipped.size();
  framing_.skip(skipped);
  begin_ = position;
  searched_ = std::max(searched_, begin_);
}

}  // namespace leonav
