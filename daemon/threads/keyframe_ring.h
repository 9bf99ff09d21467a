// The KeyframeRing passes keyframes from the GNSS thread to the smoother's thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/smoother/keyframe.h"
#include "daemon/threads/wakeup.h"
#include "daemon/threads/work_counter.h"

namespace leonav {

// Keyframes are written in place, for each is half a megabyte. Exactly two threads.
class KeyframeRing {
 public:
  KeyframeRing(std::size_t capacity, Wakeup* consumer)
      : capacity_(capacity),
        slots_(std::make_unique<KeyframeInput[]>(capacity)),
        consumer_(consumer) {}

  // Producer: where to write the next one; nullptr: full.
  KeyframeInput* next() {
    const WorkCount work = work_.count();
    return work.pushed - work.done == capacity_ ? nullptr : &slots_[work.pushed % capacity_];
  }
  void push() {
    work_.push();
    consumer_->notify();
  }

  // Consumer: calls use(keyframe) in place, then frees it. False: empty.
  template <typename Use>
  bool consume_one(Use&& use) {
    const WorkCount work = work_.count();
    if (work.pushed == work.done) return false;
    use(slots_[work.done % capacity_]);
    work_.finish();
    return true;
  }

  // Any thread.
  bool idle() const { return work_.idle(); }
  WorkCount count() const { return work_.count(); }

 private:
  std::size_t capacity_;
  std::unique_ptr<KeyframeInput[]> slots_;
  Wakeup* consumer_;
  WorkCounter work_;
};

}  // namespace leonav
