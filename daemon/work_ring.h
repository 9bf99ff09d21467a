// A queue of fixed capacity between exactly two threads. A full one makes the producer wait, and
// counts that; nothing is ever dropped.
#pragma once
#include <algorithm>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "daemon/backoff.h"
#include "daemon/wakeup.h"

namespace leonav {

struct RingStatistics {
  std::uint64_t high_water_percent = 0;  // fullest it has been
  std::uint64_t waits = 0;               // how often the producer found it full
};

// Of a ring, or of all rings to one thread.
struct WorkCount {
  std::uint64_t done = 0, pushed = 0;
};

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
    pushed_.fetch_add(1, std::memory_order_release);
    consumer_->notify();
  }

  // Consumer: calls use(work) on the element in place, then frees it. False: empty.
  template <typename Use>
  bool consume_one(Use&& use) {
    if (!queue_.consume_one(use)) return false;
    done_.fetch_add(1, std::memory_order_release);
    return true;
  }

  // Any thread: everything that was pushed has been dealt with.
  bool idle() const {
    return done_.load(std::memory_order_acquire) == pushed_.load(std::memory_order_acquire);
  }
  // What was done is read first, so that it is never more than what was pushed.
  WorkCount count() const {
    const std::uint64_t done = done_.load(std::memory_order_acquire);
    return {done, pushed_.load(std::memory_order_acquire)};
  }
  RingStatistics statistics() const {
    return {100 * high_water_.load(std::memory_order_relaxed) / capacity_,
            waits_.load(std::memory_order_relaxed)};
  }

 private:
  std::size_t capacity_;
  boost::lockfree::spsc_queue<T> queue_;
  Wakeup* consumer_;
  std::atomic<std::uint64_t> pushed_{0}, done_{0}, waits_{0}, high_water_{0};
};

}  // namespace leonav
