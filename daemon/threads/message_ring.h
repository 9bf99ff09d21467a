// The MessageRing is a queue of messages of differing length between exactly two threads.
#pragma once
#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <cstring>

#include "daemon/threads/backoff.h"
#include "daemon/threads/wakeup.h"
#include "daemon/threads/work_ring.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/wire.h"

namespace leonav {

struct MessageHeader {
  std::int64_t timestamp_us = 0;
  std::uint32_t size = 0;
  Channel channel = Channel::kImu;
};

// It holds a fixed number of bytes and never allocates. A full ring makes the producer wait, and
// that is counted.
class MessageRing {
 public:
  MessageRing(std::size_t capacity_bytes, Wakeup* consumer);

  // Producer. `bytes` at most wire::kMaxMessageBytes + 1.
  void push(Channel channel, std::int64_t timestamp_us, ByteSpan bytes);
  // As push(), but where there is no room it returns false instead of waiting.
  bool try_push(Channel channel, std::int64_t timestamp_us, ByteSpan bytes);

  // Producer: the share of the ring that is in use, at most.
  double fill() const {
    return 1.0 - static_cast<double>(queue_.write_available()) / static_cast<double>(capacity_);
  }

  // Consumer: the share of the ring that waits, at least.
  double waiting() const {
    return static_cast<double>(queue_.read_available()) / static_cast<double>(capacity_);
  }
  // Consumer: calls use(header, bytes) on the oldest message. False: empty.
  template <typename Use>
  bool consume_one(Use&& use) {
    MessageHeader header;
    if (queue_.read_available() < sizeof header) return false;
    // A message is pushed in one piece, so with its header its bytes are there too.
    queue_.pop(reinterpret_cast<std::uint8_t*>(&header), sizeof header);
    queue_.pop(incoming_.data(), header.size);
    use(header, ByteSpan(incoming_.data(), header.size));
    work_.finish();
    return true;
  }

  // Consumer: the same for all messages present at the call. Those pushed meanwhile are left, so
  // that a fast producer cannot hold the consumer for ever.
  template <typename Use>
  void consume_present(Use&& use) {
    const std::uint64_t pushed = work_.count().pushed;
    while (work_.count().done < pushed && consume_one(use)) {
    }
  }

  bool idle() const { return work_.idle(); }
  WorkCount count() const { return work_.count(); }
  RingStatistics statistics() const;

 private:
  using Buffer = std::array<std::uint8_t, sizeof(MessageHeader) + wire::kMaxMessageBytes + 1>;
  std::size_t capacity_;
  boost::lockfree::spsc_queue<std::uint8_t> queue_;
  Wakeup* consumer_;
  Buffer outgoing_;  // of the producer
  Buffer incoming_;  // of the consumer
  WorkCounter work_;
  std::atomic<std::uint64_t> waits_{0}, high_water_{0};
};

}  // namespace leonav
