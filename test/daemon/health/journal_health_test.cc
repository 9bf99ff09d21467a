// What is wrong with the journal is told calmly, and pieces are kept for faults alone.
#include "daemon/health/journal_health.h"

#include <cerrno>

#include "daemon/health/keep_rule.h"
#include "journal/journal_rig.h"
#include "support/temporary_file.h"

using namespace leonav;
using namespace leonav::test;

TEST_CASE("losses of a disk that is barely fast enough are one state until it is calm") {
  const TemporaryFile folder("unused", "");
  Disk disk;
  Journal journal(small_pieces(folder.beside("run.journal")), disk.hook());
  journal.open();
  REQUIRE(await([&] { return journal.counters().pieces.get() == 1; }));
  Sender sender(&journal);
  JournalHealth health;
  double now_s = 0.0;
  const auto look = [&](double after_s) {
    health.look(journal, now_s += after_s);
    return health.has(JournalTrouble::kLoses);
  };
  CHECK_FALSE(look(1.0));
  for (int second = 0; second < 3; ++second) {
    disk.block(true);
    sender.push(1);
    disk.await_call();
    sender.push(2000);
    CHECK(look(1.0));
    disk.block(false);
    REQUIRE(await([&] { return sender.rests(); }));
    CHECK(look(1.0));  // though nothing was lost
  }
  CHECK(look(9.0));
  CHECK(health.text(JournalTrouble::kLoses) == "journal: messages are lost");
  CHECK_FALSE(health.has(JournalTrouble::kFails));
  CHECK_FALSE(look(0.1));
}

TEST_CASE("failures and unconfirmed writes between two looks are told all the same") {
  const TemporaryFile folder("unused", "");
  Disk disk;
  const std::string path = folder.beside("run.journal");
  Journal journal(small_pieces(path), disk.hook());
  journal.open();
  Sender sender(&journal);
  sender.push_slowly(10);
  JournalHealth health;
  health.look(journal, 1.0);
  CHECK_FALSE(health.has(JournalTrouble::kFails));
  disk.fail_with(EIO);
  sender.push(1);
  REQUIRE(await([&] { return !journal.failure().empty(); }));
  disk.fail_with(0);
  REQUIRE(await([&] { return journal.failure().empty(); }));
  health.look(journal, 2.0);
  CHECK(health.has(JournalTrouble::kFails));
  CHECK(health.text(JournalTrouble::kFails) ==
        "journal: " + path + ": cannot be written: Input/output error");
  CHECK_FALSE(health.has(JournalTrouble::kUnsynced));
  health.look(journal, 12.0);
  CHECK(health.has(JournalTrouble::kFails));
  health.look(journal, 12.1);
  CHECK_FALSE(health.has(JournalTrouble::kFails));
  // At the end of a piece the disk does not confirm it.
  disk.choose(DiskCall::kSync);
  disk.fail_with(EIO);
  sender.push_slowly(200);
  health.look(journal, 13.0);
  CHECK(health.has(JournalTrouble::kUnsynced));
  CHECK(health.text(JournalTrouble::kUnsynced) ==
        "journal: the disk has not confirmed what was written");
  CHECK_FALSE(health.has(JournalTrouble::kFails));
}

TEST_CASE("pieces are kept for a fault, for inputs that come back, and for nothing else") {
  using enum Fault;
  const auto kept_at = [](const std::vector<Fault>& faults) {
    KeepRule rule;
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < faults.size(); ++i)
      if (rule.look(faults[i])) list.push_back(i);
    return list;
  };
  using List = std::vector<std::size_t>;
  // Before there is an answer.
  CHECK(kept_at({kNavigation, kSilence, kNavigation, kNone, kNone}) == List{});
  CHECK(kept_at({kNone, kNavigation, kNavigation, kNone, kNavigation}) == List{1, 4});
  // Switched off, and stopped a little later.
  CHECK(kept_at({kNone, kSilence, kSilence, kSilence}) == List{});
  // The run went on; or what came then was no answer.
  CHECK(kept_at({kNone, kSilence, kSilence, kNone, kNone}) == List{3});
  CHECK(kept_at({kNone, kSilence, kNavigation, kNavigation, kNone}) == List{2});
  CHECK(kept_at({kNavigation, kSilence, kNone}) == List{});
}
