#include "drivers/ubx/ubx_framer.h"

#include <algorithm>

namespace leonav {
namespace {

constexpr std::uint8_t kSync1 = 0xB5;
constexpr std::uint8_t kSync2 = 0x62;

}  // namespace

std::size_t UbxFramer::append(std::span<const std::uint8_t> bytes) {
  if (begin_ > base_ && end_ - base_ + bytes.size() > kCapacity) {
    const auto move_down = [this](auto& array) {
      std::copy(array.begin() + static_cast<std::ptrdiff_t>(begin_ - base_),
                array.begin() + static_cast<std::ptrdiff_t>(end_ - base_), array.begin());
    };
    move_down(buffer_);
    move_down(sum_);
    move_down(sum_of_sums_);
    base_ = begin_;
  }
  const std::size_t count = std::min<std::size_t>(bytes.size(), kCapacity - (end_ - base_));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = end_ - base_;
    buffer_[index] = bytes[i];
    last_sum_ = static_cast<std::uint8_t>(last_sum_ + bytes[i]);
    last_sum_of_sums_ = static_cast<std::uint8_t>(last_sum_of_sums_ + last_sum_);
    sum_[index] = last_sum_;
    sum_of_sums_[index] = last_sum_of_sums_;
    ++end_;
  }
  return count;
}

// The 8-bit Fletcher checksum of bytes [first, last] follows from running sums: with S and T the
// sums up to and including a byte, A = S(last) - S(first-1), B = T(last) - T(first-1) - n
// S(first-1). A candidate therefore costs the same whatever its length field is, and a stream full
// of false syncs cannot make the search slow.
bool UbxFramer::checksum_is_good(Position start, Position end) const {
  const std::size_t first = start + 2 - base_, last = end - 3 - base_;
  const auto n = static_cast<std::uint8_t>(last - first + 1);
  const std::uint8_t before = sum_[first - 1];
  const auto a = static_cast<std::uint8_t>(sum_[last] - before);
  const auto b = static_cast<std::uint8_t>(sum_of_sums_[last] - sum_of_sums_[first - 1] -
                                           static_cast<std::uint8_t>(n * before));
  return a == buffer_[last + 1] && b == buffer_[last + 2];
}

void UbxFramer::find_starts() {
  for (; searched_ + kHeader <= end_; ++searched_) {
    const auto from = buffer_.begin() + static_cast<std::ptrdiff_t>(searched_ - base_);
    const auto to = buffer_.begin() + static_cast<std::ptrdiff_t>(end_ - base_ - kHeader + 1);
    searched_ += static_cast<Position>(std::find(from, to, kSync1) - from);
    if (searched_ + kHeader > end_) return;
    if (at(searched_ + 1) != kSync2) continue;
    const std::size_t length = at(searched_ + 4) | (at(searched_ + 5) << 8);
    if (length > kMaxPayload) {
      starts_.add_refused(searched_, kOversize);
    } else {
      starts_.add(searched_, searched_ + length + kOverhead);
    }
  }
}

bool UbxFramer::next(UbxMessage* message) {
  find_starts();
  while (const auto candidate = starts_.next_whole(end_)) {
    if (checksum_is_good(candidate->start, candidate->end)) {
      take(candidate->start, candidate->end, message);
      return true;
    }
    starts_.refuse(*candidate, kBadChecksum);
  }
  skip_what_is_none();
  return false;
}

void UbxFramer::take(Position start, Position end, UbxMessage* message) {
  skip_to(start);
  message->message_class = at(start + 2);
  message->id = at(start + 3);
  message->payload = std::span<const std::uint8_t>(buffer_).subspan(start + kHeader - base_,
                                                                    end - start - kOverhead);
  begin_ = end;
  searched_ = std::max(searched_, begin_);
  starts_.drop_before(end);
  ++counters_.messages;
  foreign_.interrupt();
}

// Bytes before the first start that still waits belong to no message.
void UbxFramer::skip_what_is_none() {
  if (finished_) return skip_to(end_);
  skip_to(starts_.first_waiting().value_or(std::max(searched_, begin_)));
}

void UbxFramer::skip_to(Position position) {
  const MessageStarts::Counts none = starts_.drop_before(position);
  (finished_ ? counters_.incomplete : counters_.bad_checksums) += none[MessageStarts::kWaiting];
  counters_.bad_checksums += none[kBadChecksum];
  counters_.oversize += none[kOversize];
  for (; begin_ < position; ++begin_) {
    foreign_.take(at(begin_));
    ++counters_.bytes_skipped;
  }
  searched_ = std::max(searched_, begin_);
}

UbxFramerCounters UbxFramer::counters() const {
  UbxFramerCounters counters = counters_;
  counters.foreign = foreign_.counters();
  return counters;
}

}  // namespace leonav
