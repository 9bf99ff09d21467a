#include "daemon/threads/message_ring.h"

#include <algorithm>

namespace leonav {

MessageRing::MessageRing(std::size_t capacity_bytes, Wakeup* consumer)
    : capacity_(std::max(capacity_bytes, 2 * sizeof(Buffer))),
      queue_(capacity_),
      consumer_(consumer) {
  // Every page is touched once, so that the process does not grow as the ring goes round.
  outgoing_.fill(0);
  while (queue_.push(outgoing_.data(), outgoing_.size()) > 0) {
  }
  queue_.reset();
}

void MessageRing::push(Channel channel, std::int64_t timestamp_us, ByteSpan bytes) {
  if (try_push(channel, timestamp_us, bytes)) return;
  waits_.fetch_add(1, std::memory_order_relaxed);
  Backoff backoff;
  do {
    consumer_->notify();
    backoff.pause();
  } while (!try_push(channel, timestamp_us, bytes));
}

bool MessageRing::try_push(Channel channel, std::int64_t timestamp_us, ByteSpan bytes) {
  bytes = bytes.first(std::min(bytes.size(), wire::kMaxMessageBytes + 1));
  MessageHeader header;
  const std::size_t total = sizeof header + bytes.size();
  if (queue_.write_available() < total) return false;
  std::memset(static_cast<void*>(&header), 0, sizeof header);  // padding too: it is copied
  header.timestamp_us = timestamp_us;
  header.size = static_cast<std::uint32_t>(bytes.size());
  header.channel = channel;
  std::memcpy(outgoing_.data(), &header, sizeof header);
  std::copy(bytes.begin(), bytes.end(), outgoing_.begin() + sizeof header);
  queue_.push(outgoing_.data(), total);
  const std::uint64_t filled = capacity_ - queue_.write_available();
  if (filled > high_water_.load(std::memory_order_relaxed)) {
    high_water_.store(filled, std::memory_order_relaxed);
  }
  work_.push();
  consumer_->notify();
  return true;
}

RingStatistics MessageRing::statistics() const {
  return {100 * high_water_.load(std::memory_order_relaxed) / capacity_,
          waits_.load(std::memory_order_relaxed)};
}

}  // namespace leonav
