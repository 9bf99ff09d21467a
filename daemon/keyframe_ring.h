// Keyframes on their way from the GNSS thread to the smoother's: written in place, for each is half
// a megabyte. Exactly two threads.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/smoother/keyframe.h"
#include "daemon/work_ring.h"

namespace leonav {

class KeyframeRing {
 public:
  KeyframeRing(std::size_t capacity, Wakeup* consumer)
      : capacity_(capacity),
        slots_(std::make_unique<KeyframeInput[]>(capacity)),
        consumer_(consumer) {}

  // Producer: where to write the next one; nullptr: full.
  KeyframeInput* next() {
    const std::uint64_t pushed = pushed_.load(std::memory_order_relaxed);
    const std::uint64_t filled = pushed - done_.load(std::memory_order_acquire);
    if (filled > high_water_.load(std::memory_order_relaxed))
      high_water_.store(filled, std::memory_order_relaxed);
    return filled == capacity_ ? nullptr : &slots_[pushed % capacity_];
  }
  void push() {
    pushed_.fetch_add(1, std::memory_order_release);
    consumer_->notify();
  }

  // Consumer: calls use(keyframe) in place, then frees it. False: empty.
  template <typename Use>
  bool consume_one(Use&& use) {
    const std::uint64_t done = done_.load(std::memory_order_relaxed);
    if (pushed_.load(std::memory_order_acquire) == done) return false;
    use(slots_[done % capacity_]);
    done_.fetch_add(1, std::memory_order_release);
    return true;
  }

  // Any thread.
  bool idle() const {
    return done_.load(std::memory_order_acquire) == pushed_.load(std::memory_order_acquire);
  }
  WorkCount count() const {
    const std::uint64_t done = done_.load(std::memory_order_acquire);
    return {done, pushed_.load(std::memory_order_acquire)};
  }
  std::uint64_t high_water_percent() const {
    return 100 * high_water_.load(std::memory_order_relaxed) / capacity_;
  }

 private:
  std::size_t capacity_;
  std::unique_ptr<KeyframeInput[]> slots_;
  Wakeup* consumer_;
  std::atomic<std::uint64_t> pushed_{0}, done_{0}, high_water_{0};
};

}  // namespace leonav
