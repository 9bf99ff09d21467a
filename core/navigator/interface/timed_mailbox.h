// TimedMailbox hands one result per epoch from a worker to the inertial stage before a deadline.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "core/base/capacity.h"

namespace leonav {

// Slot k % kMaxMailboxEpochs serves epoch k. The Sequencer's side opens it, one worker delivers,
// the inertial stage takes. A single compare-exchange decides between deliver() and take(), so that
// a result is either visible at the deadline or never. Results are copied. Allocates when
// constructed, not after.
template <typename T>
class TimedMailbox {
 public:
  TimedMailbox() : slots_(std::make_unique<Slots>()) {}

  // Opens the slot; call it on the Sequencer's side before the worker gets the epoch. Returns false
  // if an earlier epoch still occupies the slot: then this epoch is a miss.
  bool open(std::uint64_t epoch);

  // Delivers the worker's result. Returns false and drops it if the deadline has passed or the slot
  // was never opened.
  bool deliver(std::uint64_t epoch, const T& result);

  // Returns, for the worker, whether the deadline has not passed yet.
  bool is_open(std::uint64_t epoch) {
    return slot(epoch).tag.load(std::memory_order_acquire) == tag(epoch, kOpen);
  }

  // Takes the result at the deadline; call it in the inertial stage. True: *result is committed.
  // False: the epoch is cancelled, a miss.
  bool take(std::uint64_t epoch, T* result);

  // Returns what take() returns, or has returned, to the stage that feeds the worker, and frees
  // nothing. Call it after the deadline in data time, and before the worker gets epoch
  // `epoch` + kMaxMailboxEpochs.
  bool read(std::uint64_t epoch, T* result);

  // Makes deliver() fail and take() return a miss, to replay a recorded miss.
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
  // take() reads `value` only after it has seen kReady. Writing first is therefore safe even if a
  // cancel wins the exchange below.
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
bool TimedMailbox<T>::read(std::uint64_t epoch, T* result) {
  Slot& s = slot(epoch);
  std::uint64_t expected = tag(epoch, kOpen);
  if (s.tag.compare_exchange_strong(expected, tag(epoch, kCancelled), std::memory_order_acq_rel)) {
    return false;
  }
  if (expected != tag(epoch, kReady) && expected != tag(epoch, kFree)) return false;
  *result = s.value;
  return true;
}

template <typename T>
void TimedMailbox<T>::cancel(std::uint64_t epoch) {
  std::uint64_t expected = tag(epoch, kOpen);
  slot(epoch).tag.compare_exchange_strong(expected, tag(epoch, kCancelled),
                                          std::memory_order_acq_rel);
}

}  // namespace leonav
