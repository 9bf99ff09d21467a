#include "drivers/ubx/ubx_framer.h"

#include <algorithm>

namespace leonav {
namespace {

constexpr std::uint8_t kSync1 = 0xB5;
constexpr std::uint8_t kSync2 = 0x62;

}  // namespace

std::size_t UbxFramer::append(std::span<const std::uint8_t> bytes) {
  if (begin_ > 0 && end_ + bytes.size() > kCapacity) {
    const auto move_down = [this](auto& array) {
      std::copy(array.begin() + begin_, array.begin() + end_, array.begin());
    };
    move_down(buffer_);
    move_down(sum_);
    move_down(sum_of_sums_);
    end_ -= begin_;
    begin_ = 0;
  }
  const std::size_t count = std::min(bytes.size(), kCapacity - end_);
  for (std::size_t i = 0; i < count; ++i) {
    buffer_[end_] = bytes[i];
    last_sum_ = static_cast<std::uint8_t>(last_sum_ + bytes[i]);
    last_sum_of_sums_ = static_cast<std::uint8_t>(last_sum_of_sums_ + last_sum_);
    sum_[end_] = last_sum_;
    sum_of_sums_[end_] = last_sum_of_sums_;
    ++end_;
  }
  return count;
}

// The 8-bit Fletcher checksum of bytes [first, last] follows from running sums: with S and T the
// sums up to and including a byte, A = S(last) - S(first-1), B = T(last) - T(first-1) - n
// S(first-1). A candidate therefore costs the same whatever its length field is, and a stream full
// of false syncs cannot make the search slow.
bool UbxFramer::checksum_is_good(std::size_t first, std::size_t last) const {
  const auto n = static_cast<std::uint8_t>(last - first + 1);
  const std::uint8_t before = sum_[first - 1];
  const auto a = static_cast<std::uint8_t>(sum_[last] - before);
  const auto b = static_cast<std::uint8_t>(sum_of_sums_[last] - sum_of_sums_[first - 1] -
                                           static_cast<std::uint8_t>(n * before));
  return a == buffer_[last + 1] && b == buffer_[last + 2];
}

bool UbxFramer::next(UbxMessage* message) {
  while (end_ - begin_ >= kOverhead) {
    if (buffer_[begin_] != kSync1 || buffer_[begin_ + 1] != kSync2) {
      skip_to_sync();
      continue;
    }
    const std::size_t length = buffer_[begin_ + 4] | (buffer_[begin_ + 5] << 8);
    if (length > kMaxPayload) {
      ++counters_.oversize;
      skip(1);
      continue;
    }
    if (end_ - begin_ < length + kOverhead) {
      if (!finished_) return false;
      ++counters_.incomplete;
      skip(1);
      continue;
    }
    if (!checksum_is_good(begin_ + 2, begin_ + 5 + length)) {
      ++counters_.bad_checksums;
      skip(1);
      continue;
    }
    message->message_class = buffer_[begin_ + 2];
    message->id = buffer_[begin_ + 3];
    message->payload = std::span(buffer_).subspan(begin_ + 6, length);
    begin_ += length + kOverhead;
    ++counters_.messages;
    foreign_.interrupt();
    return true;
  }
  if (finished_) skip(end_ - begin_);
  return false;
}

UbxFramerCounters UbxFramer::counters() const {
  UbxFramerCounters counters = counters_;
  counters.foreign = foreign_.counters();
  return counters;
}

void UbxFramer::skip(std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) foreign_.take(buffer_[begin_ + i]);
  begin_ += count;
  counters_.bytes_skipped += count;
}

void UbxFramer::skip_to_sync() {
  const auto from = buffer_.begin() + begin_ + 1;
  const auto found = std::find(from, buffer_.begin() + end_, kSync1);
  skip(static_cast<std::size_t>(found - from) + 1);
}

}  // namespace leonav
