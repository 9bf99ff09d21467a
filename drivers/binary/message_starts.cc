#include "drivers/binary/message_starts.h"

#include <algorithm>

namespace leonav {

void MessageStarts::add(Position start, Position end) {
  starts_.push_back({start, kWaiting});
  waiting_.emplace(end, start);
}

void MessageStarts::add_refused(Position start, Reason reason) {
  starts_.push_back({start, reason});
}

MessageStarts::Start* MessageStarts::find(Position position) {
  const auto found = std::lower_bound(
      starts_.begin() + static_cast<std::ptrdiff_t>(first_), starts_.end(), position,
      [](const Start& start, Position sought) { return start.position < sought; });
  return found != starts_.end() && found->position == position ? &*found : nullptr;
}

std::optional<MessageStarts::Candidate> MessageStarts::next_whole(Position bytes_end) {
  while (!waiting_.empty() && waiting_.top().first <= bytes_end) {
    const auto [end, start] = waiting_.top();
    waiting_.pop();
    // Others lay within a message that was taken.
    if (find(start) != nullptr) return Candidate{start, end};
  }
  return std::nullopt;
}

void MessageStarts::refuse(const Candidate& candidate, Reason reason) {
  find(candidate.start)->reason = reason;
}

MessageStarts::Counts MessageStarts::drop_before(Position position) {
  Counts counts{};
  for (; first_ < starts_.size() && starts_[first_].position < position; ++first_)
    ++counts[starts_[first_].reason];
  // Moved down only when as many go as stay, so that a start costs the same however many there are.
  if (2 * first_ >= starts_.size()) {
    starts_.erase(starts_.begin(), starts_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
  }
  return counts;
}

std::optional<MessageStarts::Position> MessageStarts::first_waiting() const {
  const auto found =
      std::find_if(starts_.begin() + static_cast<std::ptrdiff_t>(first_), starts_.end(),
                   [](const Start& start) { return start.reason == kWaiting; });
  if (found == starts_.end()) return std::nullopt;
  return found->position;
}

}  // namespace leonav
