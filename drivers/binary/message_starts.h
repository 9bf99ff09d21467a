// This unit puts the starts of possible messages in a stream of bytes in order, so that a false
// start, or a damaged length, holds back nothing that comes behind it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

namespace leonav {

// A framer adds every start that it finds, once, with the end that the start claims. Of all of them
// the one whose message is whole first comes first; whether it is good is the framer's to test.
// Memory is kept, so that a stream costs no allocation once it has run for a while.
class MessageStarts {
 public:
  using Position = std::uint64_t;  // of a byte in the whole stream
  // Why a start is none.
  enum Reason : std::uint8_t {
    kWaiting,  // not known yet
    kBadChecksum,
    kImpossible,  // a length or a field that no message has
    kBadContent,  // a good checksum by chance
    kCutHeader,   // cut off by the end of the stream, within the header
    kReasons      // their number
  };
  using Counts = std::array<std::uint64_t, kReasons>;
  struct Candidate {
    Position start, end;
  };

  // A start is added behind all others.
  void add(Position start, Position end);
  void add_refused(Position start, Reason reason);

  // Takes the next start whose message ends at or before `bytes_end`, the one that ends first.
  std::optional<Candidate> next_whole(Position bytes_end);
  // The candidate is none.
  void refuse(const Candidate& candidate, Reason reason);

  // Forgets the starts before `position`; returns how many there were, by their reasons.
  Counts drop_before(Position position);
  // The first start that waits, behind those that have been refused.
  std::optional<Position> first_waiting() const;

 private:
  struct Start {
    Position position;
    Reason reason;
  };
  using EndAndStart = std::pair<Position, Position>;

  // Null: dropped.
  Start* find(Position position);

  std::vector<Start> starts_;  // in order; those before first_ are dropped
  std::size_t first_ = 0;
  std::priority_queue<EndAndStart, std::vector<EndAndStart>, std::greater<>> waiting_;
};

}  // namespace leonav
