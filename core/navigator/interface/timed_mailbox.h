// A TimedMailbox hands one result per epoch from a worker to the inertial stage before a deadline.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "core/base/capacity.h"

namespace leonav {

// Slot k % N serves epoch k. The Sequencer's side opens it, one worker per epoch delivers, the
// inertial stage takes. A single compare-exchange decides between deliver() and take(), so that a
// result is either visible at the deadline or never. T is copied; slots are allocated once.
template <typename T>
class TimedMailbox {
 public:
  TimedMailbox() : slots_(std::make_unique<Slots>()) {}

  // Sequencer side: opens the slot before the worker is given the epoch. False if the slot is still
  // under way from N epochs ago.
  bool open(std::uint64_t epoch);

  // Worker side. False: the deadline has passed (or the slot was never opened); the result is
  // dropped.
  bool deliver(std::uint64_t epoch, const T& result);

  // Worker side: the deadline has not passed yet.
  bool is_open(std::uint64_t epoch) {
    return slot(epoch).tag.load(std::memory_order_acquire) == tag(epoch, kOpen);
  }

  // Inertial stage, at the deadline. True and *result: committed. False: cancelled, a miss.
  bool take(std::uint64_t epoch, T* result);

  // Makes epoch's deliver() fail and its take() report a miss: replay of a recorded miss.
  void cancel(std::uint64_t epoch);

 private:
  enum State : std::uint32_t { kFree, kOpen, kReady, kCancelled };
  struct Slot {
    std::atomic<std::uint64_t> tag{0};  // epoch << 2 | state
    T value{};
  };
  using Slots = std::array<Slot, kMaxMailboxEpochs>;
  static std::uint64_t tag(std::uint64_t epoch, State state) { return epoch << 2 | state; }
  Slot& slot(std::uint64_t epoch) { return (*slots_)[epoch % kMaxMailboxEpochs]; }
  std::unique_ptr<Slots> slots_;
};

template <typename T>
bool TimedMailbox<T>::open(std::uint64_t epoch) {
  Slot& s = slot(epoch);
  std::uint64_t seen = s.tag.load(std::memory_order_acquire);
  const auto state = static_cast<State>(seen & 3U);
  if (state == kOpen || state == kReady) return false;
  return s.tag.compare_exchange_strong(seen, tag(epoch, kOpen), std::memory_order_acq_rel);
}

template <typename T>
bool TimedMailbox<T>::deliver(std::uint64_t epoch, const T& result) {
  Slot& s = slot(epoch);
  std::uint64_t expected = tag(epoch, kOpen);
  if (s.tag.load(std::memory_order_acquire) != expected) return false;
  // The navigator reads `value` only after it has seen kReady, so writing first is safe even if the
  // exchange below is then lost to a cancel.
  s.value = result;
  return s.tag.compare_exchange_strong(expected, tag(epoch, kReady), std::memory_order_acq_rel);
}

template <typename T>
bool TimedMailbox<T>::take(std::uint64_t epoch, T* result) {
  Slot& s = slot(epoch);
  std::uint64_t expected = tag(epoch, kOpen);
  if (s.tag.compare_exchange_strong(expected, tag(epoch, kCancelled), std::memory_order_acq_rel)) {
    return false;
  }
  if (expected != tag(epoch, kReady)) return false;
  *result = s.value;
  s.tag.store(tag(epoch, kFree), std::memory_order_release);
  return true;
}

template <typename T>
void TimedMailbox<T>::cancel(std::uint64_t epoch) {
  std::uint64_t expected = tag(epoch, kOpen);
  slot(epoch).tag.compare_exchange_strong(expected, tag(epoch, kCancelled),
                                          std::memory_order_acq_rel);
}

}  // namespace leonav
