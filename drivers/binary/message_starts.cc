#include "drivers/binary/message_starts.h"

#include <algorithm>

namespace leonav {

void MessageStarts::add(Position start, Position end) {
  reasons_.emplace_hint(reasons_.end(), start, kWaiting);
  waiting_.emplace(end, start);
}

void MessageStarts::add_refused(Position start, std::size_t reason) {
  reasons_.emplace_hint(reasons_.end(), start, reason);
}

std::optional<MessageStarts::Candidate> MessageStarts::next_whole(Position bytes_end) {
  while (!waiting_.empty() && waiting_.top().first <= bytes_end) {
    const auto [end, start] = waiting_.top();
    waiting_.pop();
    // Others lay within a message that was taken.
    if (reasons_.contains(start)) return Candidate{start, end};
  }
  return std::nullopt;
}

void MessageStarts::refuse(const Candidate& candidate, std::size_t reason) {
  reasons_.at(candidate.start) = reason;
}

MessageStarts::Counts MessageStarts::drop_before(Position position) {
  Counts counts{};
  while (!reasons_.empty() && reasons_.begin()->first < position) {
    ++counts[reasons_.begin()->second];
    reasons_.erase(reasons_.begin());
  }
  return counts;
}

std::optional<MessageStarts::Position> MessageStarts::first_waiting() const {
  const auto found = std::find_if(reasons_.begin(), reasons_.end(),
                                  [](const auto& start) { return start.second == kWaiting; });
  if (found == reasons_.end()) return std::nullopt;
  return found->first;
}

}  // namespace leonav
