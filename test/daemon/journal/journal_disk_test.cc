// A journal on a disk that blocks, fills up, fails and comes back; its pieces and their limits.
#include <fcntl.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "core/navigator/interface/event.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/lcm/event_header.h"
#include "drivers/lcm/piece_file.h"
#include "journal/journal_rig.h"
#include "support/drive/drive_inputs.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"
#include "tools/common/allocations/allocation_counter.h"

using namespace leonav;
using namespace leonav::test;

TEST_CASE("pieces are begun by size, and read as one journal from the first piece or the folder") {
  const TemporaryFile folder("unused", "");
  const std::string path = folder.beside("run.journal");
  Journal journal(small_pieces(path));
  journal.open();
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
  JournalRig rig([](JournalConfig* journal) {
    journal->piece_s = 0.05;
    journal->piece_mb = 100.0;
  });
  rig.journal.open();
  while (rig.journal.counters().pieces.get() < 3) {
    rig.sender.push(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  CHECK(rig.journal.finish());
  check_all(rig.config.journal.path, rig.sender.sent());
}

TEST_CASE("the oldest pieces make room, of earlier runs first; no other file is touched") {
  const TemporaryFile folder("unused", "");
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  {
    Journal journal(config);
    journal.open();
    Sender(&journal).push_slowly(300);
    REQUIRE(journal.finish());
  }
  const std::string piece = text_of(folder.beside("run.journal.part0002"));
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
  REQUIRE(await([&] { return journal.has_file(); }));
  REQUIRE(journal.path() == folder.beside("run.journal.1"));
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
  JournalRig rig;
  rig.journal.open();
  rig.sender.push_slowly(50);
  rig.disk.block(true);
  rig.sender.push(5);
  rig.disk.await_call();
  CHECK_FALSE(rig.journal.is_stalled());  // not yet
  rig.sender.push(5000);                  // five times what there is room for
  const std::int64_t lost = rig.journal.counters().lost_others.get();
  CHECK(lost > 3500);
  CHECK(lost < 4500);
  rig.disk.block(false);
  while (rig.journal.counters().journaled.get() < 800)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  rig.sender.push_slowly(50);
  CHECK_FALSE(rig.journal.finish());
  CHECK(rig.journal.error().find(" messages are missing, which the disk did not take in time") !=
        std::string::npos);
  const Contents found = contents(rig.config.journal.path);
  CHECK(found.ended);
  REQUIRE(found.lost.size() == 1);
  CHECK(found.lost[0].others == static_cast<std::uint64_t>(lost));
  CHECK(found.lost[0].solutions == 0);
  REQUIRE(found.numbers.size() + static_cast<std::size_t>(lost) == rig.sender.sent());
  // Whole before the mark and behind it, and the mark is where they are missing.
  for (std::size_t i = 0; i < found.numbers.size(); ++i)
    REQUIRE(found.numbers[i] ==
            i + (i < found.number_at_loss ? 0 : static_cast<std::uint64_t>(lost)));
}

TEST_CASE("where the memory is half full SOLUTION is left out, and nothing else") {
  JournalRig rig;
  rig.journal.open();
  rig.disk.block(true);
  rig.sender.push(1, Channel::kSolution);
  rig.disk.await_call();
  for (int i = 0; i < 800; ++i) {  // 0.8 MB
    rig.sender.push(1, i % 4 == 0 ? Channel::kImu : Channel::kSolution);
  }
  const std::int64_t left_out = rig.journal.counters().lost_solutions.get();
  CHECK(left_out > 200);
  CHECK(rig.journal.counters().lost_others.get() == 0);
  rig.disk.block(false);
  while (rig.journal.counters().journaled.get() <
         static_cast<std::int64_t>(rig.sender.sent()) - left_out)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  rig.sender.push(1, Channel::kSolution);
  CHECK(rig.journal.finish());  // a replay lacks nothing
  const Contents found = contents(rig.config.journal.path);
  REQUIRE(found.lost.size() == 1);
  CHECK(found.lost[0].solutions == static_cast<std::uint64_t>(left_out));
  CHECK(found.lost[0].others == 0);
  CHECK(found.numbers.size() + static_cast<std::size_t>(left_out) == rig.sender.sent());
}

TEST_CASE(
    "a disk that fails for a while loses nothing that the memory holds; a new piece is begun") {
  JournalRig rig([](JournalConfig* journal) { journal->piece_mb = 100.0; });
  rig.journal.open();
  for (const int error : {EIO, EROFS}) {
    rig.sender.push_slowly(50);
    rig.disk.fail_with(error);
    rig.sender.push(100);
    while (rig.journal.failure().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    CHECK(rig.journal.failure() ==
          rig.config.journal.path + ": cannot be written: " + std::strerror(error));
    rig.sender.push(100);
    rig.disk.fail_with(0);
    while (!rig.journal.failure().empty())
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    rig.sender.settle();
  }
  CHECK(rig.journal.counters().failures.get() >= 2);
  CHECK(rig.journal.finish());
  CHECK(names(rig.folder.path()) ==
        std::set<std::string>{"run.journal", "run.journal.part0002", "run.journal.part0003"});
  check_all(rig.config.journal.path, rig.sender.sent());
}

TEST_CASE("a disk that fails from the first byte on, and never comes back, is told at the end") {
  JournalRig rig;
  rig.disk.fail_with(ENOSPC);
  rig.journal.open();
  rig.sender.push(10);
  CHECK_FALSE(rig.journal.finish());
  CHECK(rig.journal.error() ==
        rig.config.journal.path + ": cannot be written: No space left on device");
  CHECK(names(rig.folder.path()).empty());
}

TEST_CASE("a disk that fails before anything is written and comes back has one piece, whole") {
  JournalRig rig;
  rig.disk.fail_with(EIO);
  rig.journal.open();
  rig.sender.push(10);
  while (rig.journal.counters().failures.get() < 2)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  rig.disk.fail_with(0);
  rig.sender.settle();
  CHECK(rig.journal.finish());
  CHECK(names(rig.folder.path()) == std::set<std::string>{"run.journal"});
  check_all(rig.config.journal.path, rig.sender.sent());
}

TEST_CASE("a disk that never returns holds up no end") {
  const TemporaryFile folder("unused", "");
  Disk disk;
  {
    DaemonConfig config = small_pieces(folder.beside("run.journal"));
    Journal journal(config, disk.hook());
    journal.open();
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
  JournalRig rig([](JournalConfig* journal) {
    journal->total_mb = 0.3;
    journal->kept_mb = 0.5;
  });
  rig.journal.open();
  rig.sender.push_slowly(150);  // in the second piece
  rig.journal.keep();
  rig.sender.push_slowly(1000);
  CHECK(rig.journal.counters().kept.get() == 2);
  CHECK(fs::exists(rig.folder.beside("run.journal.kept")));
  CHECK(fs::exists(rig.folder.beside("run.journal.part0002.kept")));
  CHECK_FALSE(fs::exists(rig.folder.beside("run.journal.part0003")));
  // An event of the filter asks for it, a command does not.
  const auto event = [&](EventKind kind, ResetCause cause) {
    std::vector<std::uint8_t> bytes(39);
    bytes[wire::kEventKindOffset] = static_cast<std::uint8_t>(kind);
    bytes[wire::kEventCodeOffset] = static_cast<std::uint8_t>(cause);
    rig.journal.push({1, 39, Channel::kEvent}, bytes);
    rig.sender.push_slowly(500);
  };
  event(EventKind::kFilterReset, ResetCause::kCommand);
  event(EventKind::kOutageOver, ResetCause::kPrediction);
  CHECK(rig.journal.counters().kept.get() == 2);
  event(EventKind::kFilterReset, ResetCause::kPrediction);
  CHECK(rig.journal.counters().kept.get() == 4);
  event(EventKind::kSmootherFailed, ResetCause::kCommand);
  event(EventKind::kFilterReset, ResetCause::kLockedOut);
  CHECK(rig.journal.counters().kept.get() == 8);
  REQUIRE(rig.journal.finish());
  std::uintmax_t kept = 0;
  for (const std::string& name : names(rig.folder.path()))
    if (name.ends_with(".kept")) kept += fs::file_size(rig.folder.beside(name));
  CHECK(kept <= 500'000);
  CHECK(kept > 300'000);
  CHECK_FALSE(fs::exists(rig.folder.beside("run.journal.kept")));  // the oldest
}

TEST_CASE(
    "a disk that is full for a while costs no piece; where it stays full, the oldest make room") {
  const TemporaryFile folder("unused", "");
  // A disk of 0.45 MB with a foreign file on it.
  std::atomic<std::uintmax_t> foreign{0};
  const auto small_disk = [&](DiskCall call) {
    if (call != DiskCall::kWrite) return 0;
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
  const TemporaryFile folder("unused", "");
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  config.journal.kept_mb = 10.0;
  Disk disk;
  Journal running(config, disk.hook());
  running.open();
  Sender sender(&running);
  sender.push_slowly(150);
  {
    // While the first daemon runs, its pieces are not those of a crash.
    Journal second(config);
    second.open();
    REQUIRE(await([&] { return second.has_file(); }));
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
  next.open();
  REQUIRE(await([&] { return next.has_file(); }));
  CHECK(next.counters().kept.get() == 2);
  CHECK(fs::exists(last + ".kept"));
  CHECK(fs::exists(config.journal.path + ".kept"));
  REQUIRE(next.finish());
}

TEST_CASE("a disk that is full, read-only, absent or stalled at the start delays nobody") {
  const TemporaryFile folder("unused", "");
  const std::string path = folder.beside("later/run.journal");
  SECTION("its folder comes later") {
    Journal journal(small_pieces(path));
    journal.open();
    CHECK(journal.failure() == path + ": cannot be written: No such file or directory");
    Sender sender(&journal);
    sender.push(100);
    fs::create_directory(folder.beside("later"));
    REQUIRE(await([&] { return journal.failure().empty(); }));
    CHECK(journal.finish());
    check_all(path, sender.sent());
  }
  fs::create_directories(folder.beside("later"));
  Disk disk;
  Journal journal(small_pieces(path), disk.hook());
  SECTION("it is read-only") {
    disk.fail_with(EROFS);
    journal.open();
    CHECK(journal.failure() == path + ": cannot be written: Read-only file system");
    CHECK(journal.path() == path);
    CHECK_FALSE(journal.has_file());
    Sender sender(&journal);
    sender.push(100);
    disk.fail_with(0);
    REQUIRE(await([&] { return journal.failure().empty(); }));
    CHECK(journal.finish());
    check_all(path, sender.sent());
  }
  SECTION("it does not answer") {
    disk.block(true);
    const Stopwatch watch;
    journal.open();
    CHECK(watch.nanoseconds() < 3 * kNanosecondsPerSecond);
    Sender sender(&journal);
    sender.push(100);
    CHECK(await([&] { return journal.is_stalled(); }));
    disk.block(false);
    REQUIRE(await([&] { return journal.has_file(); }));
    CHECK(journal.finish());
    check_all(path, sender.sent());
  }
}

TEST_CASE("a path that can never be a journal ends the start") {
  const TemporaryFile file("file", "");
  const auto open = [](const std::string& path) { Journal(small_pieces(path)).open(); };
  CHECK_THROWS_WITH(open(file.path() + "/run.journal"),
                    file.path() + "/run.journal: cannot be created: Not a directory");
  fs::create_directory(file.beside("folder"));
  CHECK_THROWS_WITH(open(file.beside("folder")),
                    file.beside("folder") + ": cannot be created: Is a directory");
  CHECK_THROWS_WITH(open(file.beside(std::string(300, 'x'))),
                    Catch::Matchers::Contains("cannot be created: File name too long"));
  CHECK(names(file.path()) == std::set<std::string>{"file", "folder"});
}

TEST_CASE("an empty first file that cannot be deleted is used when the disk comes back") {
  const TemporaryFile folder("unused", "");
  const bool deleted = GENERATE(false, true);  // by somebody else, meanwhile
  std::atomic<bool> fails{true}, looks_fail{false};
  const auto hook = [&](DiskCall call) {
    const bool hit = call == DiskCall::kWrite || call == DiskCall::kDelete ||
                     (looks_fail && call == DiskCall::kLook);
    return fails && hit ? EIO : 0;
  };
  Journal journal(small_pieces(folder.beside("run.journal")), hook);
  journal.open();
  Sender sender(&journal);
  sender.push(10);
  REQUIRE(await([&] { return journal.counters().failures.get() >= 3; }));
  looks_fail = true;
  REQUIRE(await([&] { return journal.counters().failures.get() >= 4; }));
  CHECK(names(folder.path()) == std::set<std::string>{"run.journal"});
  if (deleted) fs::remove(folder.beside("run.journal"));
  fails = false;
  REQUIRE(await([&] { return journal.failure().empty(); }));
  CHECK(journal.finish());
  CHECK(names(folder.path()) == std::set<std::string>{"run.journal"});
  check_all(folder.beside("run.journal"), sender.sent());
}

TEST_CASE("a folder that is moved away, or deleted, is found again under its path") {
  const TemporaryFile folder("unused", "");
  const std::string path = folder.beside("journals/run.journal");
  fs::create_directory(folder.beside("journals"));
  Journal journal(small_pieces(path));
  journal.open();
  Sender sender(&journal);
  sender.push_slowly(20);
  const bool deleted = GENERATE(false, true);
  if (deleted) {
    fs::remove_all(folder.beside("journals"));
  } else {
    fs::rename(folder.beside("journals"), folder.beside("old"));
    fs::create_directory(folder.beside("journals"));
  }
  REQUIRE(await([&] { return journal.counters().pieces.get() == 2; }));
  sender.push_slowly(20);
  CHECK(journal.finish());
  CHECK(contents(path + ".part0002").numbers.size() == 20);
  if (!deleted) CHECK(contents(folder.beside("old/run.journal")).numbers.size() == 20);
}

TEST_CASE("a file that is deleted while it is written is followed by the next piece") {
  const TemporaryFile folder("unused", "");
  Journal journal(small_pieces(folder.beside("run.journal")));
  journal.open();
  Sender sender(&journal);
  sender.push_slowly(20);
  fs::remove(folder.beside("run.journal"));
  REQUIRE(await([&] { return journal.counters().pieces.get() == 2; }));
  sender.push_slowly(20);
  CHECK(journal.finish());
  CHECK(names(folder.path()) == std::set<std::string>{"run.journal.part0002"});
}

TEST_CASE("what is written goes to the disk every few seconds; a disk that refuses is told") {
  const TemporaryFile folder("unused", "");
  Disk disk;
  disk.choose(DiskCall::kSync);
  Journal journal(small_pieces(folder.beside("run.journal")), disk.hook());
  journal.open();
  Sender sender(&journal);
  sender.push_slowly(20);
  REQUIRE(await([&] { return disk.calls(DiskCall::kSync) >= 2; }));  // the file, and its name
  CHECK(journal.counters().unsynced.get() == 0);
  // At the end of a piece.
  disk.fail_with(EIO);
  sender.push_slowly(200);
  CHECK(journal.counters().unsynced.get() >= 2);
  CHECK(journal.failure().empty());
  disk.fail_with(0);
  CHECK(journal.finish());
  check_all(folder.beside("run.journal"), sender.sent());
}

TEST_CASE("runs follow one another, whatever the clock was before") {
  const TemporaryFile folder("unused", "");
  const std::string path = folder.beside("run.journal");
  const auto run_of = [&](const std::string& journal) {
    return EventLogReader(journal).first_piece().value().run;
  };
  const auto write = [&] {
    Journal journal(small_pieces(path));
    journal.open();
    Sender(&journal).push_slowly(5);
    REQUIRE(journal.finish());
    return run_of(journal.path());
  };
  const std::int64_t first = write();
  CHECK(std::abs(first - wall_clock_us()) < 60'000'000);
  // Of a clock that was ten years ahead, and one that is not believed.
  const auto set_run = [&](const std::string& journal, std::int64_t run) {
    std::string bytes = text_of(journal);
    const auto mark = encode_piece({run, 1, 1, RecordedOutputs::kAll});
    bytes.replace(kEventHeaderBytes + std::string("LEONAV_PIECE").size(), mark.size(),
                  std::string(mark.begin(), mark.end()));
    std::ofstream(journal, std::ios::binary) << bytes;
  };
  const std::int64_t ahead = first + 315'360'000'000'000;
  set_run(path, ahead);
  CHECK(write() == ahead + 1);
  set_run(path + ".1", kGreatestRun);
  CHECK(write() == ahead + 1);
  CHECK(write() == ahead + 2);
}

TEST_CASE("a piece that cannot be deleted does not save the others") {
  const TemporaryFile folder("unused", "");
  const std::string path = folder.beside("run.journal");
  DaemonConfig config = small_pieces(path);
  config.journal.total_mb = 0.5;
  // The first two deletions fail, each time the limits are applied those of the oldest.
  std::atomic<int> deletions{0};
  std::atomic<int> left{4};
  Journal journal(config, [&](DiskCall call) {
    if (call != DiskCall::kDelete) return 0;
    ++deletions;
    return left-- > 0 ? EPERM : 0;
  });
  journal.open();
  Sender sender(&journal);
  sender.push_slowly(1000);
  REQUIRE(journal.finish());
  CHECK(journal.counters().undeletable.get() == 4);
  CHECK(journal.counters().deleted.get() >= 4);
  CHECK(journal.counters().deleted.get() + 4 == deletions);
  std::uintmax_t total = 0;
  for (const std::string& name : names(path)) total += fs::file_size(folder.beside(name));
  CHECK(total <= 500'000);
}

TEST_CASE("pieces that end by failures are limited as well") {
  const TemporaryFile folder("unused", "");
  const std::string path = folder.beside("run.journal");
  Disk disk;
  DaemonConfig config = small_pieces(path);
  config.journal.total_mb = 0.3;
  Journal journal(config, disk.hook());
  disk.choose(DiskCall::kWrite);
  journal.open();
  Sender sender(&journal);
  for (int piece = 1; piece <= 8; ++piece) {
    sender.push_slowly(80);  // less than a piece holds
    disk.fail_with(EIO);
    sender.push(1);
    REQUIRE(await([&] { return !journal.failure().empty(); }));
    disk.fail_with(0);
    REQUIRE(await([&] { return journal.failure().empty(); }));
  }
  REQUIRE(journal.finish());
  std::uintmax_t total = 0;
  for (const std::string& name : names(path)) total += fs::file_size(folder.beside(name));
  CHECK(total <= 300'000);
  CHECK(journal.counters().deleted.get() >= 5);
}

TEST_CASE("with kept_mb 0 nothing is kept, and what was kept earlier stays") {
  const TemporaryFile folder("unused", "");
  const std::string path = folder.beside("run.journal");
  DaemonConfig config = small_pieces(path);
  config.journal.kept_mb = 0.5;
  {
    Journal journal(config);
    journal.open();
    Sender sender(&journal);
    sender.push_slowly(50);
    journal.keep();
    sender.push_slowly(10);
    REQUIRE(journal.finish());
    CHECK(journal.take_kept() == path + ".kept");
    CHECK_FALSE(journal.take_kept());
  }
  config.journal.kept_mb = 0.0;
  config.journal.total_mb = 0.3;
  std::atomic<bool> full{false};
  Journal journal(config,
                  [&](DiskCall call) { return full && call == DiskCall::kWrite ? ENOSPC : 0; });
  journal.open();
  Sender sender(&journal);
  sender.push_slowly(500);
  journal.keep();
  sender.push_slowly(200);
  CHECK(journal.counters().kept.get() == 0);
  // Not even where the disk has no room.
  full = true;
  sender.push(700);
  REQUIRE(await([&] { return journal.counters().failures.get() >= 4; }));
  full = false;
  journal.finish();
  CHECK(fs::exists(path + ".kept"));
}

TEST_CASE("a disk that does not answer while a piece is deleted or renamed counts as stalled") {
  const TemporaryFile folder("unused", "");
  Disk disk;
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  config.journal.total_mb = 0.2;
  const DiskCall call = GENERATE(DiskCall::kDelete, DiskCall::kRename, DiskCall::kLook);
  disk.choose(call);
  Journal journal(config, disk.hook());
  journal.open();
  REQUIRE(await([&] { return journal.counters().pieces.get() == 1; }));
  disk.block(true);
  journal.keep();
  Sender(&journal).push(500);
  CHECK(await([&] { return journal.is_stalled(); }));
  disk.block(false);
  CHECK(journal.finish());
  CHECK_FALSE(journal.is_stalled());
}

TEST_CASE("a piece that has ended looks in use until the next one has begun") {
  JournalRig rig([](JournalConfig* journal) { journal->kept_mb = 10.0; });
  rig.journal.open();
  rig.sender.push_slowly(50);
  rig.disk.fail_with(EIO);
  rig.sender.push(1);
  REQUIRE(await([&] { return !rig.journal.failure().empty(); }));
  // Its only file has no end mark and is written by nobody at present.
  Journal second(rig.config);
  second.open();
  REQUIRE(await([&] { return second.has_file(); }));
  CHECK(second.counters().kept.get() == 0);
  CHECK(second.finish());
  rig.disk.fail_with(0);
  CHECK(rig.journal.finish());
  check_all(rig.folder.beside("run.journal"), rig.sender.sent());
}

TEST_CASE("files with holes count as what they take of the disk, and overflow no sum") {
  if (!fs::exists("/dev/shm")) return;
  std::string name = "/dev/shm/leonav-test-XXXXXX";
  REQUIRE(::mkdtemp(name.data()) != nullptr);
  DaemonConfig config = small_pieces(name + "/run.journal");
  const auto write = [&](int messages) {
    Journal journal(config);
    journal.open();
    Sender(&journal).push_slowly(messages);
    CHECK(journal.finish());
    return journal.counters().deleted.get();
  };
  for (int i = 0; i < 3; ++i) write(10);
  std::error_code error;
  for (const char* one : {"/run.journal", "/run.journal.1", "/run.journal.2"})
    fs::resize_file(name + one, std::uintmax_t{1} << 62, error);
  config.journal.total_mb = 0.3;
  if (!error) {
    CHECK(write(10) == 0);
    CHECK(write(1000) > 3);
    CHECK_FALSE(fs::exists(name + "/run.journal"));  // the oldest first, as ever
  }
  fs::remove_all(name);
}

TEST_CASE("the last mark of what is lost has the next number") {
  const TemporaryFile folder("unused", "");
  Disk disk;
  Journal journal(small_pieces(folder.beside("run.journal")), disk.hook());
  journal.open();
  Sender sender(&journal);
  sender.push_slowly(5);
  for (int mark = 1; mark <= 2; ++mark) {
    disk.block(true);
    sender.push(1);
    disk.await_call();
    sender.push(2000);
    disk.block(false);
    if (mark == 1) {
      REQUIRE(await([&] { return journal.ring().high_water_percent > 90 && sender.rests(); }));
      sender.push(1);
      sender.settle();
    }
  }
  CHECK_FALSE(journal.finish());
  EventLogReader log(folder.beside("run.journal"));
  std::vector<std::int64_t> sequences;
  for (LogEvent event; log.next(&event);)
    if (channel_from_name(event.channel) == Channel::kLost)
      sequences.push_back(wire::read_int64(event.data, wire::kSequenceOffset));
  CHECK(sequences == std::vector<std::int64_t>{1, 2});
}

TEST_CASE("limits that are set while it is written hold at once, for the pieces that are there") {
  const TemporaryFile folder("unused", "");
  const std::string path = folder.beside("run.journal");
  const DaemonConfig config = small_pieces(path);
  Journal journal(config);
  journal.open();
  Sender sender(&journal);
  sender.push_slowly(1000);
  REQUIRE(names(path).size() >= 10);
  JournalLimits limits = limits_of(config.journal);
  limits.total_mb = 0.3;
  journal.set_limits(limits);
  CHECK(await([&] { return names(path).size() <= 3; }));  // without a message more
  limits.piece_mb = 100.0;
  limits.total_mb = 0.0;
  journal.set_limits(limits);
  const std::int64_t pieces = journal.counters().pieces.get();
  sender.push(1);
  sender.settle();
  sender.push_slowly(1000);
  REQUIRE(journal.finish());
  CHECK(journal.counters().pieces.get() <= pieces + 1);
  CHECK(contents(fs::path(path).parent_path()).numbers.back() == sender.sent() - 1);
}

TEST_CASE("the journal's thread allocates nothing, whatever the disk does") {
  const TemporaryFile folder("unused", "");
  Disk disk;
  DaemonConfig config = small_pieces(folder.beside("run.journal"));
  config.journal.total_mb = 0.3;
  config.journal.kept_mb = 0.3;
  const auto before = thread_allocations();
  Journal journal(config, disk.hook());
  journal.open();
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
