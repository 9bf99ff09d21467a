// A journal never overwrites a file, and its name stands for one run.
#include "daemon/journal/internal/journal_path.h"

#include <filesystem>

#include "daemon/journal/journal.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/drive_inputs.h"
#include "support/temporary_file.h"

using namespace leonav;

TEST_CASE("the numbers of journals end, with a remedy; what is no file is written as it is") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("journal");
  CHECK(claim_journal_path(path, 2) == path);
  CHECK(claim_journal_path(path, 2) == path + ".1");
  std::filesystem::remove(path + ".1");
  std::filesystem::create_directory(path + ".1");
  CHECK(claim_journal_path(path, 2) == path + ".2");
  CHECK_THROWS_WITH(claim_journal_path(path, 2),
                    path + ": exists, and so do .1 to .2; move the journals away");
  CHECK(claim_journal_path("/dev/null") == "/dev/null");
  CHECK(claim_journal_path(folder.beside("absent/journal")) == folder.beside("absent/journal"));
  DaemonConfig config = test::drive_config();
  config.journal.path = folder.beside("absent/journal");
  CHECK_THROWS_AS(Journal(config).open(), EventLogError);
}

TEST_CASE("a journal whose first piece is gone keeps its name") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("journal");
  for (const char* ending : {".part0007", ".1.kept"}) std::ofstream(path + ending) << "a piece";
  CHECK(claim_journal_path(path) == path + ".2");
}
