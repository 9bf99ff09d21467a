// A LatestValue passes the newest value from one thread to another; older ones are overwritten.
#pragma once
#include <array>
#include <atomic>

namespace leonav {

// One thread sets, one takes; neither ever waits. There are three slots: one is written, one is
// read, and the third holds the value that was set or taken last.
template <typename T>
class LatestValue {
 public:
  void set(const T& value) {
    slots_[written_] = value;
    written_ = between_.exchange(written_ | kNew, std::memory_order_acq_rel) & kSlot;
  }

  // False: nothing has been set since the last call.
  bool take(T* value) {
    if ((between_.load(std::memory_order_relaxed) & kNew) == 0) return false;
    read_ = between_.exchange(read_, std::memory_order_acq_rel) & kSlot;
    *value = slots_[read_];
    return true;
  }

 private:
  static constexpr unsigned kSlot = 3, kNew = 4;
  std::array<T, 3> slots_{};
  unsigned written_ = 0, read_ = 1;
  std::atomic<unsigned> between_{2};
};

}  // namespace leonav
