// A Wakeup wakes a thread that has run out of work; neither side allocates.
#pragma once
#include <atomic>
#include <cstdint>

namespace leonav {

class Wakeup {
 public:
  // To be drawn before the search for work; wait() takes it if there is none.
  std::uint32_t ticket() const { return count_.load(std::memory_order_acquire); }
  // Returns at once if notify() was called since the ticket was drawn.
  void wait(std::uint32_t ticket) const { count_.wait(ticket, std::memory_order_acquire); }
  void notify() {
    count_.fetch_add(1, std::memory_order_acq_rel);
    count_.notify_all();
  }

 private:
  std::atomic<std::uint32_t> count_{0};
};

}  // namespace leonav
