// A WorkCounter counts the pieces of work pushed to a thread, and those it has done.
#pragma once
#include <atomic>
#include <cstdint>

namespace leonav {

// Of a ring, or of all rings to one thread.
struct WorkCount {
  std::uint64_t done = 0, pushed = 0;
};

// One thread pushes, another finishes; any thread reads.
class WorkCounter {
 public:
  void push() { pushed_.fetch_add(1, std::memory_order_release); }
  void finish() { done_.fetch_add(1, std::memory_order_release); }

  // `done` is read first, so that it never exceeds `pushed`.
  WorkCount count() const {
    const std::uint64_t done = done_.load(std::memory_order_acquire);
    return {done, pushed_.load(std::memory_order_acquire)};
  }
  bool idle() const {
    const WorkCount work = count();
    return work.done == work.pushed;
  }

 private:
  std::atomic<std::uint64_t> pushed_{0}, done_{0};
};

}  // namespace leonav
