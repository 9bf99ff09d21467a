// A disk that blocks and fails on demand, a sender of messages, and what a journal then holds.
#pragma once
#include <array>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "daemon/journal/journal.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/journal_marks.h"
#include "drivers/lcm/run_configuration.h"
#include "drivers/lcm/wire.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav::test {

namespace fs = std::filesystem;

// The disk, as the journal's thread meets it. Who calls it may outlive the test.
class Disk {
 public:
  DiskHook hook() {
    return [shared = shared_](DiskCall call) {
      std::unique_lock lock(shared->mutex);
      ++shared->calls[static_cast<std::size_t>(call)];
      ++shared->waiting;
      shared->changed.notify_all();
      shared->changed.wait(
          lock, [&] { return !shared->blocked || (shared->only && *shared->only != call); });
      --shared->waiting;
      return shared->only && *shared->only != call ? 0 : shared->error;
    };
  }
  // Blocks and fails calls of one kind alone.
  void choose(DiskCall only) {
    const std::lock_guard lock(shared_->mutex);
    shared_->only = only;
  }
  int calls(DiskCall call) const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->calls[static_cast<std::size_t>(call)];
  }
  void block(bool blocked) {
    const std::lock_guard lock(shared_->mutex);
    shared_->blocked = blocked;
    shared_->changed.notify_all();
  }
  void fail_with(int error) {
    const std::lock_guard lock(shared_->mutex);
    shared_->error = error;
  }
  // Waits until the journal waits.
  void await_call() {
    std::unique_lock lock(shared_->mutex);
    shared_->changed.wait(lock, [this] { return shared_->waiting > 0; });
  }

 private:
  struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    bool blocked = false;
    std::optional<DiskCall> only;
    int error = 0, waiting = 0;
    std::array<int, 6> calls{};
  };
  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
};

inline DaemonConfig small_pieces(const std::string& path) {
  DaemonConfig config;
  config.journal.path = path;
  config.journal.flush_interval_s = 0.0;
  config.journal.buffer_mb = 1.0;
  config.journal.piece_mb = 0.1;
  config.journal.total_mb = 0.0;
  return config;
}

inline constexpr std::size_t kMessageBytes = 1000;

// Pushes messages whose first bytes are their number, as slowly as the disk takes them.
class Sender {
 public:
  explicit Sender(Journal* journal) : journal_(journal) {}
  void push(int count, Channel channel = Channel::kImu) {
    for (int i = 0; i < count; ++i) {
      std::vector<std::uint8_t> bytes(kMessageBytes);
      const std::uint64_t number = sent_++;
      for (int k = 0; k < 8; ++k) bytes[16 + k] = static_cast<std::uint8_t>(number >> (56 - 8 * k));
      journal_->push({1, static_cast<std::uint32_t>(bytes.size()), channel}, bytes);
    }
  }
  void push_slowly(int count) {
    for (int i = 0; i < count; ++i) {
      push(1);
      if (i % 20 == 19) settle();
    }
  }
  // Waits until all that was pushed is with the operating system.
  void settle() const {
    while (!rests()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  bool rests() const {
    return journal_->counters().journaled.get() >=
           static_cast<std::int64_t>(sent_) - journal_->counters().lost_others.get();
  }
  std::uint64_t sent() const { return sent_; }

 private:
  Journal* journal_;
  std::uint64_t sent_ = 0;
};

// A journal of small pieces on such a disk, not yet opened, and its sender.
struct JournalRig {
  TemporaryFile folder{"unused", ""};
  Disk disk;
  DaemonConfig config;
  Journal journal;
  Sender sender{&journal};

  // `change`: of the configuration.
  explicit JournalRig(void (*change)(JournalConfig*) = nullptr)
      : config(changed(small_pieces(folder.beside("run.journal")), change)),
        journal(config, disk.hook()) {}

 private:
  static DaemonConfig changed(DaemonConfig config, void (*change)(JournalConfig*)) {
    if (change != nullptr) change(&config.journal);
    return config;
  }
};

struct Contents {
  std::vector<std::uint64_t> numbers;  // of the sender's messages
  std::vector<LostMessages> lost;
  std::size_t number_at_loss = 0;  // messages before the first mark
  std::int64_t missing = 0;
  bool ended = false;
};

inline Contents contents(const std::string& path) {
  EventLogReader log(path);
  Contents found;
  LogEvent event;
  std::int64_t before = 0;
  for (; log.next(&event); ++before) {
    const auto channel = channel_from_name(event.channel);
    REQUIRE(channel.has_value());
    if (*channel == Channel::kImu || *channel == Channel::kSolution)
      found.numbers.push_back(static_cast<std::uint64_t>(wire::read_int64(event.data, 16)));
    if (*channel == Channel::kLost) {
      if (found.lost.empty()) found.number_at_loss = found.numbers.size();
      found.lost.push_back(decode_lost(event.data).value());
    }
    found.ended = *channel == Channel::kEnd && decode_journal_end(event.data) == before;
  }
  found.missing = log.missing();
  CHECK_FALSE(log.truncated());
  return found;
}

inline void check_all(const std::string& path, std::uint64_t sent) {
  const Contents found = contents(path);
  CHECK(found.ended);
  CHECK(found.missing == 0);
  CHECK(found.lost.empty());
  REQUIRE(found.numbers.size() == sent);
  for (std::uint64_t i = 0; i < sent; ++i) REQUIRE(found.numbers[i] == i);
}

inline std::set<std::string> names(const std::string& beside) {
  std::set<std::string> list;
  for (const auto& entry : fs::directory_iterator(fs::path(beside).parent_path()))
    list.insert(entry.path().filename());
  list.erase("unused");
  return list;
}

// Waits, ten seconds at most, until it holds.
template <typename Condition>
bool await(Condition condition) {
  for (int i = 0; i < 5000 && !condition(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return condition();
}

}  // namespace leonav::test
