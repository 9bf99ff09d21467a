// A journal on a disk that blocks, fills up, fails and comes back; its pieces and their limits.
#include <fcntl.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "core/navigator/interface/event.h"
#include "daemon/journal/journal.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/journal_marks.h"
#include "drivers/lcm/piece_file.h"
#include "drivers/lcm/run_configuration.h"
#include "drivers/lcm/wire.h"
#include "support/catch.h"
#include "support/drive_inputs.h"
#include "support/program_run.h"
#include "support/temporary_file.h"
#include "tools/common/allocations/allocation_counter.h"

namespace {

using namespace leonav;
namespace fs = std::filesystem;

// The disk, as the journal's thread meets it. Who calls it may outlive the test.
class Disk {
 public:
  std::function<int()> hook() {
    return [shared = shared_] {
      std::unique_lock lock(shared->mutex);
      ++shared->waiting;
      shared->changed.notify_all();
      shared->changed.wait(lock, [&] { return !shared->blocked; });
      --shared->waiting;
      return shared->error;
    };
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
    int error = 0, waiting = 0;
  };
  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
};

DaemonConfig small_pieces(const std::string& path) {
  DaemonConfig config;
  config.journal.path = path;
  config.journal.flush_interval_s = 0.0;
  config.journal.buffer_mb = 1.0;
  config.journal.piece_mb = 0.1;
  config.journal.total_mb = 0.0;
  return config;
}

constexpr std::size_t kMessageBytes = 1000;

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
    while (journal_->counters().journaled.get() <
           static_cast<std::int64_t>(sent_) - journal_->counters().lost_others.get())
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::uint64_t sent() const { return sent_; }

 private:
  Journal* journal_;
  std::uint64_t sent_ = 0;
};

struct Contents {
  std::vector<std::uint64_t> numbers;  // of the sender's messages
  std::vector<LostMessages> lost;
  std::size_t number_at_loss = 0;  // messages before the first mark
  std::int64_t missing = 0;
  bool ended = false;
};

Contents contents(const std::string& path) {
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

void check_all(const std::string& path, std::uint64_t sent) {
  const Contents found = contents(path);
  CHECK(found.ended);
  CHECK(found.missing == 0);
  CHECK(found.lost.empty());
  REQUIRE(found.numbers.size() == sent);
  for (std::uint64_t i = 0; i < sent; ++i) REQUIRE(found.numbers[i] == i);
}

std::set<std::string> names(const std::string& beside) {
  std::set<std::string> list;
  for (const auto& entry : fs::directory_iterator(fs::path(beside).parent_path()))
    list.insert(entry.path().filename());
  list.erase("unused");
  return list;
}

}  // namespace

TEST_CASE("pieces are begun by size, and read as one journal from the first piece or the folder") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("run.journal");
  Journal journal(small_pieces(path));
  journal.open();
  journal.start();
  Sender sender(&journal);
  sender.push_slowly(1000);  // 1 MB
  CHECK(journal.finish());
  CHECK(journal.error().empty());
  CHECK(journal.counters().pieces.get() >= 10);
  CHECK(fs::exists(path + ".part0002"));
  for (const std::string& name : names(path)) CHECK(fs::file_size(folder.beside(name)) < 130'000);
  check_all(path, sender.sent());
  check_all(fs::path(path).parent_path(), sender.sent());
  // From a piece in the middle: the rest, and that there was something before.
  const Contents rest = contents(path + ".part0003");
  CHECK(rest.missing > 0);
  CHECK(rest.numbers.size() + static_cast<std::size_t>(rest.missing) == sender.sent());
  CHECK(rest.numbers.back() == sender.sent() - 1);
  CHECK_FALSE(rest.ended);
}

TEST_CASE("pieces are begun by time") {
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  config.journal.piece_s = 0.05;
  config.journal.piece_mb = 100.0;
  Journal journal(config);
  journal.open();
  journal.start();
  Sender sender(&journal);
  while (journal.counters().pieces.get() < 3) {
    sender.push(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  CHECK(journal.finish());
  check_all(config.journal.path, sender.sent());
}

TEST_CASE("the oldest pieces make room, of earlier runs first; no other file is touched") {
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  {
    Journal journal(config);
    journal.open();
    journal.start();
    Sender(&journal).push_slowly(300);
    REQUIRE(journal.finish());
  }
  const std::string piece = test::text_of(folder.beside("run.journal.part0002"));
  // Named as pieces, but none: a log of an older version, and something else. Pieces, but of
  // another name.
  {
    EventLogWriter old(folder.beside("run.journal.2"));
    REQUIRE(old.write(1, "LEONAV_CONFIG", std::vector<std::uint8_t>(300'000)));
    REQUIRE(old.write(1, "LEONAV_IMU", std::vector<std::uint8_t>(300'000)));
    REQUIRE(old.flush());
  }
  std::ofstream(folder.beside("run.journal.part0099")) << std::string(300'000, 'x');
  for (const char* other : {"run.journal.old", "other.journal", "run.journal.part0001.txt"})
    std::ofstream(folder.beside(other)) << piece;
  const std::set<std::string> before = names(folder.path());

  config.journal.total_mb = 0.5;
  Journal journal(config);
  journal.open();
  REQUIRE(journal.path() == folder.beside("run.journal.1"));
  journal.start();
  Sender sender(&journal);
  sender.push_slowly(1500);
  REQUIRE(journal.finish());
  CHECK(journal.counters().deleted.get() >= 10);
  std::uintmax_t total = 0;
  const std::set<std::string> after = names(folder.path());
  for (const std::string& name : after)
    if (name.starts_with("run.journal.1")) total += fs::file_size(folder.beside(name));
  CHECK(total <= 500'000);
  CHECK(total > 300'000);
  for (const char* left : {"run.journal.2", "run.journal.part0099", "run.journal.old",
                           "other.journal", "run.journal.part0001.txt"})
    CHECK(after.count(left) == 1);
  CHECK(after.count("run.journal") == 0);
  CHECK(after.count("run.journal.1") == 0);
  // What is left is read, with the number of what is gone.
  std::string first;
  for (const std::string& name : after)
    if (name.starts_with("run.journal.1.part") && first.empty()) first = name;
  const Contents found = contents(folder.beside(first));
  CHECK(found.missing > 1000);
  CHECK(found.numbers.back() == sender.sent() - 1);
}

TEST_CASE("a disk that blocks costs what the memory does not hold, and a mark says how much") {
  const test::TemporaryFile folder("unused", "");
  Disk disk;
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  Journal journal(config, disk.hook());
  journal.open();
  journal.start();
  Sender sender(&journal);
  sender.push_slowly(50);
  disk.block(true);
  sender.push(5);
  disk.await_call();
  CHECK_FALSE(journal.is_stalled());  // not yet
  sender.push(5000);                  // five times what there is room for
  const std::int64_t lost = journal.counters().lost_others.get();
  CHECK(lost > 3500);
  CHECK(lost < 4500);
  disk.block(false);
  while (journal.counters().journaled.get() < 800)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  sender.push_slowly(50);
  CHECK_FALSE(journal.finish());
  CHECK(journal.error().find(" messages are missing, which the disk did not take in time") !=
        std::string::npos);
  const Contents found = contents(config.journal.path);
  CHECK(found.ended);
  REQUIRE(found.lost.size() == 1);
  CHECK(found.lost[0].others == static_cast<std::uint64_t>(lost));
  CHECK(found.lost[0].solutions == 0);
  REQUIRE(found.numbers.size() + static_cast<std::size_t>(lost) == sender.sent());
  // Whole before the mark and behind it, and the mark is where they are missing.
  for (std::size_t i = 0; i < found.numbers.size(); ++i)
    REQUIRE(found.numbers[i] ==
            i + (i < found.number_at_loss ? 0 : static_cast<std::uint64_t>(lost)));
}

TEST_CASE("where the memory is half full SOLUTION is left out, and nothing else") {
  const test::TemporaryFile folder("unused", "");
  Disk disk;
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  Journal journal(config, disk.hook());
  journal.open();
  journal.start();
  Sender sender(&journal);
  disk.block(true);
  sender.push(1, Channel::kSolution);
  disk.await_call();
  for (int i = 0; i < 800; ++i) {  // 0.8 MB
    sender.push(1, i % 4 == 0 ? Channel::kImu : Channel::kSolution);
  }
  const std::int64_t left_out = journal.counters().lost_solutions.get();
  CHECK(left_out > 200);
  CHECK(journal.counters().lost_others.get() == 0);
  disk.block(false);
  while (journal.counters().journaled.get() < static_cast<std::int64_t>(sender.sent()) - left_out)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  sender.push(1, Channel::kSolution);
  CHECK(journal.finish());  // a replay lacks nothing
  const Contents found = contents(config.journal.path);
  REQUIRE(found.lost.size() == 1);
  CHECK(found.lost[0].solutions == static_cast<std::uint64_t>(left_out));
  CHECK(found.lost[0].others == 0);
  CHECK(found.numbers.size() + static_cast<std::size_t>(left_out) == sender.sent());
}

TEST_CASE(
    "a disk that fails for a while loses nothing that the memory holds; a new piece is begun") {
  const test::TemporaryFile folder("unused", "");
  Disk disk;
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  config.journal.piece_mb = 100.0;
  Journal journal(config, disk.hook());
  journal.open();
  journal.start();
  Sender sender(&journal);
  for (const int error : {EIO, EROFS}) {
    sender.push_slowly(50);
    disk.fail_with(error);
    sender.push(100);
    while (journal.failure().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(journal.failure() ==
          config.journal.path + ": cannot be written: " + std::strerror(error));
    sender.push(100);
    disk.fail_with(0);
    while (!journal.failure().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    sender.settle();
  }
  CHECK(journal.counters().failures.get() >= 2);
  CHECK(journal.finish());
  CHECK(names(folder.path()) ==
        std::set<std::string>{"run.journal", "run.journal.part0002", "run.journal.part0003"});
  check_all(config.journal.path, sender.sent());
}

TEST_CASE("a disk that fails from the first byte on, and never comes back, is told at the end") {
  const test::TemporaryFile folder("unused", "");
  Disk disk;
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  Journal journal(config, disk.hook());
  journal.open();
  disk.fail_with(ENOSPC);
  journal.start();
  Sender sender(&journal);
  sender.push(10);
  CHECK_FALSE(journal.finish());
  CHECK(journal.error() == config.journal.path + ": cannot be written: No space left on device");
  CHECK(names(folder.path()) == std::set<std::string>{"run.journal"});
}

TEST_CASE("a disk that fails before anything is written and comes back has one piece, whole") {
  const test::TemporaryFile folder("unused", "");
  Disk disk;
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  Journal journal(config, disk.hook());
  journal.open();
  disk.fail_with(EIO);
  journal.start();
  Sender sender(&journal);
  sender.push(10);
  while (journal.counters().failures.get() < 2)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  disk.fail_with(0);
  sender.settle();
  CHECK(journal.finish());
  CHECK(names(folder.path()) == std::set<std::string>{"run.journal"});
  check_all(config.journal.path, sender.sent());
}

TEST_CASE("a disk that never returns holds up no end") {
  const test::TemporaryFile folder("unused", "");
  Disk disk;
  {
    DaemonConfig config = small_pieces(folder.beside("run.journal"));
    Journal journal(config, disk.hook());
    journal.open();
    journal.start();
    disk.block(true);
    Sender(&journal).push(10);
    disk.await_call();
    while (!journal.is_stalled()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    CHECK_FALSE(journal.finish());
    CHECK(journal.error() ==
          config.journal.path + ": the disk has not taken the end of the journal");
  }
  disk.block(false);
  // The thread goes on to its end, with the state that was left to it.
  for (int i = 0; i < 2000 && !has_end_mark(AT_FDCWD, folder.beside("run.journal").c_str()); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  CHECK(contents(folder.beside("run.journal")).ended);
}

TEST_CASE("what led up to a fault is kept beyond the limit of all, within one of its own") {
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  config.journal.total_mb = 0.3;
  config.journal.kept_mb = 0.5;
  Journal journal(config);
  journal.open();
  journal.start();
  Sender sender(&journal);
  sender.push_slowly(150);  // in the second piece
  journal.keep();
  sender.push_slowly(1000);
  CHECK(journal.counters().kept.get() == 2);
  CHECK(fs::exists(folder.beside("run.journal.kept")));
  CHECK(fs::exists(folder.beside("run.journal.part0002.kept")));
  CHECK_FALSE(fs::exists(folder.beside("run.journal.part0003")));
  // An event of the filter asks for it, a command does not.
  const auto event = [&](EventKind kind, ResetCause cause) {
    std::vector<std::uint8_t> bytes(39);
    bytes[wire::kEventKindOffset] = static_cast<std::uint8_t>(kind);
    bytes[wire::kEventCodeOffset] = static_cast<std::uint8_t>(cause);
    journal.push({1, 39, Channel::kEvent}, bytes);
    sender.push_slowly(500);
  };
  event(EventKind::kFilterReset, ResetCause::kCommand);
  event(EventKind::kOutageOver, ResetCause::kPrediction);
  CHECK(journal.counters().kept.get() == 2);
  event(EventKind::kFilterReset, ResetCause::kPrediction);
  CHECK(journal.counters().kept.get() == 4);
  event(EventKind::kSmootherFailed, ResetCause::kCommand);
  event(EventKind::kFilterReset, ResetCause::kLockedOut);
  CHECK(journal.counters().kept.get() == 8);
  REQUIRE(journal.finish());
  std::uintmax_t kept = 0;
  for (const std::string& name : names(folder.path()))
    if (name.ends_with(".kept")) kept += fs::file_size(folder.beside(name));
  CHECK(kept <= 500'000);
  CHECK(kept > 300'000);
  CHECK_FALSE(fs::exists(folder.beside("run.journal.kept")));  // the oldest
}

TEST_CASE(
    "a disk that is full for a while costs no piece; where it stays full, the oldest make room") {
  const test::TemporaryFile folder("unused", "");
  // A disk of 0.45 MB with a foreign file on it.
  std::atomic<std::uintmax_t> foreign{0};
  const auto small_disk = [&] {
    std::uintmax_t used = foreign;
    for (const std::string& name : names(folder.path())) {
      std::error_code gone;
      const auto size = fs::file_size(folder.beside(name), gone);
      if (!gone) used += size;
    }
    return used > 450'000 ? ENOSPC : 0;
  };
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  Journal journal(config, small_disk);
  journal.open();
  journal.start();
  Sender sender(&journal);
  sender.push_slowly(300);
  foreign = 1'000'000;
  sender.push(100);  // a tenth of the memory
  while (journal.counters().failures.get() < 2)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(journal.failure().find("No space left on device") != std::string::npos);
  CHECK(journal.counters().deleted.get() == 0);
  foreign = 0;
  sender.settle();
  while (!journal.failure().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(journal.counters().deleted.get() == 0);
  // Now there is no room for all of it.
  std::int64_t room = 600;
  while (journal.counters().deleted.get() < 3) {
    for (; room > 0; --room) sender.push(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    room = journal.counters().journaled.get() - static_cast<std::int64_t>(sender.sent()) + 600;
  }
  CHECK(journal.finish());
  CHECK(journal.counters().lost_others.get() == 0);
  std::string first;
  for (const std::string& name : names(folder.path()))
    if (first.empty()) first = name;
  const Contents found = contents(folder.beside(first));
  CHECK(found.missing > 100);
  CHECK(found.missing + static_cast<std::int64_t>(found.numbers.size()) ==
        static_cast<std::int64_t>(sender.sent()));
}

TEST_CASE("the end of a run that crashed is kept at the next start; a piece in use is left alone") {
  const test::TemporaryFile folder("unused", "");
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  config.journal.kept_mb = 10.0;
  const auto start = [&](Journal* journal) {
    journal->open();
    journal->start();
  };
  Disk disk;
  Journal running(config, disk.hook());
  start(&running);
  Sender sender(&running);
  sender.push_slowly(150);
  {
    // While the first daemon runs, its pieces are not those of a crash.
    Journal second(config);
    start(&second);
    CHECK(second.counters().kept.get() == 0);
    REQUIRE(second.finish());
  }
  sender.push_slowly(10);
  REQUIRE(running.finish());
  check_all(config.journal.path, sender.sent());
  // As it would be without its end.
  const std::string last = config.journal.path + ".part0002";
  REQUIRE(fs::exists(last));
  fs::remove(config.journal.path + ".1");
  fs::resize_file(last, fs::file_size(last) - 20);
  Journal next(config);
  start(&next);
  CHECK(next.counters().kept.get() == 2);
  CHECK(fs::exists(last + ".kept"));
  CHECK(fs::exists(config.journal.path + ".kept"));
  REQUIRE(next.finish());
}

TEST_CASE("the journal's thread allocates nothing, whatever the disk does") {
  const test::TemporaryFile folder("unused", "");
  Disk disk;
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  config.journal.total_mb = 0.3;
  config.journal.kept_mb = 0.3;
  const auto before = thread_allocations();
  Journal journal(config, disk.hook());
  journal.open();
  journal.start();
  Sender sender(&journal);
  sender.push_slowly(500);
  journal.keep();
  sender.push_slowly(500);
  disk.fail_with(ENOSPC);
  sender.push(300);
  while (journal.counters().failures.get() < 2)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  disk.fail_with(0);
  sender.push_slowly(200);
  REQUIRE(journal.finish());
  CHECK(journal.counters().deleted.get() > 3);
  CHECK(journal.counters().kept.get() == 2);
  CHECK(thread_allocations().journal == before.journal);
}
