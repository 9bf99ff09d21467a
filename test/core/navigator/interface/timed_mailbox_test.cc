#include "core/navigator/interface/timed_mailbox.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "support/catch.h"

namespace leonav::test {
namespace {

TEST_CASE("a result delivered in time is taken once; afterwards the slot serves again") {
  TimedMailbox<int> mailbox;
  int result = 0;
  CHECK_FALSE(mailbox.deliver(1, 10));  // never opened
  REQUIRE(mailbox.open(1));
  CHECK_FALSE(mailbox.open(1 + kMaxMailboxEpochs));  // slot still under way
  CHECK(mailbox.deliver(1, 11));
  CHECK_FALSE(mailbox.deliver(1, 12));
  CHECK(mailbox.take(1, &result));
  CHECK(result == 11);
  CHECK_FALSE(mailbox.take(1, &result));
  CHECK(mailbox.open(1 + kMaxMailboxEpochs));
  CHECK_FALSE(mailbox.deliver(1, 13));
}

TEST_CASE("after a miss or a cancel the result is dropped") {
  TimedMailbox<int> mailbox;
  int result = 0;
  REQUIRE(mailbox.open(5));
  CHECK_FALSE(mailbox.take(5, &result));
  CHECK_FALSE(mailbox.deliver(5, 1));
  REQUIRE(mailbox.open(6));
  mailbox.cancel(6);
  CHECK_FALSE(mailbox.deliver(6, 1));
  CHECK_FALSE(mailbox.take(6, &result));
  CHECK(mailbox.open(6 + kMaxMailboxEpochs));
}

TEST_CASE("who reads a result at its deadline and who takes it see the same, in either order") {
  TimedMailbox<int> mailbox;
  int taken = 0, read = 0;
  CHECK_FALSE(mailbox.read(1, &read));  // never opened
  REQUIRE(mailbox.open(1));
  CHECK(mailbox.deliver(1, 11));
  CHECK(mailbox.read(1, &read));
  CHECK(mailbox.take(1, &taken));
  CHECK(read == 11);
  CHECK(taken == 11);
  read = 0;
  CHECK(mailbox.read(1, &read));  // also once the slot is free
  CHECK(read == 11);
  REQUIRE(mailbox.open(2));
  CHECK_FALSE(mailbox.read(2, &read));  // a miss
  CHECK_FALSE(mailbox.deliver(2, 12));
  CHECK_FALSE(mailbox.take(2, &taken));
  REQUIRE(mailbox.open(3));
  CHECK_FALSE(mailbox.take(3, &taken));
  CHECK_FALSE(mailbox.read(3, &read));
  REQUIRE(mailbox.open(1 + kMaxMailboxEpochs));
  CHECK_FALSE(mailbox.read(1, &read));  // another epoch's slot by now
}

TEST_CASE("of a worker and a navigator in a race exactly one wins, and the value is whole") {
  constexpr std::uint64_t kRounds = 20'000;
  using Value = std::array<std::uint64_t, 16>;  // torn if written while read
  TimedMailbox<Value> mailbox;
  std::atomic<std::uint64_t> opened{0}, taken_rounds{0}, delivered_rounds{0};
  std::uint64_t delivered = 0, taken = 0, torn = 0;
  std::thread worker([&] {
    for (std::uint64_t k = 1; k <= kRounds; ++k) {
      while (opened.load(std::memory_order_acquire) < k) std::this_thread::yield();
      // Every fifth round the worker is surely late, every fifth surely early; the rest race.
      while (k % 5 == 0 && taken_rounds.load(std::memory_order_acquire) < k) {
        std::this_thread::yield();
      }
      Value value;
      value.fill(k);
      if (mailbox.deliver(k, value)) ++delivered;
      delivered_rounds.store(k, std::memory_order_release);
    }
  });
  std::thread navigator([&] {
    for (std::uint64_t k = 1; k <= kRounds; ++k) {
      while (opened.load(std::memory_order_acquire) < k) std::this_thread::yield();
      while (k % 5 == 1 && delivered_rounds.load(std::memory_order_acquire) < k) {
        std::this_thread::yield();
      }
      for (std::uint64_t spin = 0; spin < k % 7 * 40; ++spin) opened.load();
      Value value;
      if (mailbox.take(k, &value)) {
        ++taken;
        for (const std::uint64_t word : value) torn += word != k ? 1 : 0;
      }
      taken_rounds.store(k, std::memory_order_release);
    }
  });
  for (std::uint64_t k = 1; k <= kRounds; ++k) {
    REQUIRE(mailbox.open(k));
    opened.store(k, std::memory_order_release);
    // Sometimes in step, mostly several epochs ahead of both, as the Sequencer runs.
    const std::uint64_t lead = k % 3 == 0 ? 0 : 16;
    while (taken_rounds.load(std::memory_order_acquire) + lead < k ||
           delivered_rounds.load(std::memory_order_acquire) + lead < k) {
      std::this_thread::yield();
    }
  }
  worker.join();
  navigator.join();
  CHECK(delivered == taken);
  CHECK(torn == 0);
  CHECK(taken >= kRounds / 5);
  CHECK(taken <= kRounds - kRounds / 5);
}

TEST_CASE("who feeds the worker and reads its results sees what the navigator takes, in any race") {
  constexpr std::uint64_t kRounds = 10'000;
  using Value = std::array<std::uint64_t, 16>;
  TimedMailbox<Value> mailbox;
  std::atomic<std::uint64_t> opened{0}, fed{0}, delivered_rounds{0}, taken_rounds{0};
  std::vector<char> taken(kRounds + 1), read(kRounds + 1);
  std::uint64_t torn = 0;
  std::thread worker([&] {
    for (std::uint64_t k = 1; k <= kRounds; ++k) {
      while (fed.load(std::memory_order_acquire) < k) std::this_thread::yield();
      for (std::uint64_t spin = 0; spin < k % 5 * 40; ++spin) fed.load();
      // One in ten comes too late whatever the machine does, and one is waited for.
      while (k % 10 == 5 && taken_rounds.load(std::memory_order_acquire) < k)
        std::this_thread::yield();
      Value value;
      value.fill(k);
      mailbox.deliver(k, value);
      delivered_rounds.store(k, std::memory_order_release);
    }
  });
  std::thread feeder([&] {  // it reads the epoch before whenever it begins one
    for (std::uint64_t k = 1; k <= kRounds; ++k) {
      while (opened.load(std::memory_order_acquire) < k) std::this_thread::yield();
      for (std::uint64_t spin = 0; spin < k % 3 * 60; ++spin) opened.load();
      // What is waited for must not become a miss because this thread is ahead of the worker.
      while (k % 10 == 1 && delivered_rounds.load(std::memory_order_acquire) + 1 < k)
        std::this_thread::yield();
      Value value;
      if (k > 1 && mailbox.read(k - 1, &value)) {
        read[k - 1] = 1;
        for (const std::uint64_t word : value) torn += word != k - 1 ? 1 : 0;
      }
      fed.store(k, std::memory_order_release);
    }
  });
  std::thread navigator([&] {
    for (std::uint64_t k = 1; k <= kRounds; ++k) {
      while (opened.load(std::memory_order_acquire) < k) std::this_thread::yield();
      for (std::uint64_t spin = 0; spin < k % 7 * 40; ++spin) opened.load();
      while (k % 10 == 0 && delivered_rounds.load(std::memory_order_acquire) < k)
        std::this_thread::yield();
      Value value;
      taken[k] = mailbox.take(k, &value) ? 1 : 0;
      taken_rounds.store(k, std::memory_order_release);
    }
  });
  for (std::uint64_t k = 1; k <= kRounds; ++k) {
    REQUIRE(mailbox.open(k));
    opened.store(k, std::memory_order_release);
    const std::uint64_t lead = k % 3 == 0 ? 0 : 16;
    while (taken_rounds.load(std::memory_order_acquire) + lead < k ||
           fed.load(std::memory_order_acquire) + lead < k) {
      std::this_thread::yield();
    }
  }
  worker.join();
  feeder.join();
  navigator.join();
  taken.back() = 0;  // nobody has read the last one
  CHECK(read == taken);
  CHECK(torn == 0);
  const auto of_all = std::count(taken.begin(), taken.end(), 1);
  CHECK(of_all >= static_cast<std::ptrdiff_t>(kRounds) / 10 - 1);
  CHECK(of_all <= static_cast<std::ptrdiff_t>(kRounds) - static_cast<std::ptrdiff_t>(kRounds) / 10);
}

}  // namespace
}  // namespace leonav::test
