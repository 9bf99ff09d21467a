// The WorkRing is a queue of fixed capacity between exactly two threads.
#pragma once
#include <algorithm>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "daemon/threads/backoff.h"
#include "daemon/threads/wakeup.h"
#include "daemon/threads/work_counter.h"

namespace leonav {

struct RingStatistics {
  std::uint64_t high_water_percent = 0;  // fullest it has been
  std::uint64_t waits = 0;               // how often the producer found it full
};

// A full ring makes the producer wait, which is counted; nothing is ever dropped.
template <typename T>
class WorkRing {
 public:
  WorkRing(std::size_t capacity, Wakeup* consumer)
      : capacity_(capacity), queue_(capacity), consumer_(consumer) {}

  // Producer.
  void push(const T& work) {
    if (!queue_.push(work)) {
      waits_.fetch_add(1, std::memory_order_relaxed);
      Backoff backoff;
      do {
        consumer_->notify();
        backoff.pause();
      } while (!queue_.push(work));
    }
    const std::uint64_t filled = capacity_ - queue_.write_available();
    if (filled > high_water_.load(std::memory_order_relaxed)) {
      high_water_.store(filled, std::memory_order_relaxed);
    }
    work_.push();
    consumer_->notify();
  }

  // Consumer: calls use(work) on the element in place, then frees it. False: empty.
  template <typename Use>
  bool consume_one(Use&& use) {
    if (!queue_.consume_one(use)) return false;
    work_.finish();
    return true;
  }

  // Any thread: everything that was pushed has been processed.
  bool idle() const { return work_.idle(); }
  WorkCount count() const { return work_.count(); }
  RingStatistics statistics() const {
    return {100 * high_water_.load(std::memory_order_relaxed) / capacity_,
            waits_.load(std::memory_order_relaxed)};
  }

 private:
  std::size_t capacity_;
  boost::lockfree::spsc_queue<T> queue_;
  Wakeup* consumer_;
  WorkCounter work_;
  std::atomic<std::uint64_t> waits_{0}, high_water_{0};
};

}  // namespace leonav
