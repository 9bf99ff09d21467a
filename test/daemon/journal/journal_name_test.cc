// A journal never overwrites a file, and its name stands for one run.
#include "daemon/journal/internal/journal_name.h"

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "support/catch.h"
#include "support/temporary_file.h"

namespace {

using namespace leonav;

// As a daemon that starts with `most` as the last number.
std::optional<int> claim(const std::string& path, int most, int* error = nullptr) {
  JournalCounters counters;
  DiskCalls disk(&counters, {});
  JournalFolder folder(path, &disk);
  JournalFile file(&disk);
  REQUIRE(folder.open(false));
  const std::string name = std::filesystem::path(path).filename();
  const auto number = claim_journal(name, &folder, &file, &disk, most);
  if (error != nullptr) *error = disk.error();
  return number;
}

}  // namespace

TEST_CASE("the numbers of journals end") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("journal");
  CHECK(claim(path, 2) == 0);
  CHECK(claim(path, 2) == 1);
  std::filesystem::remove(path + ".1");
  std::filesystem::create_directory(path + ".1");
  CHECK(claim(path, 2) == 2);
  int error = 0;
  CHECK_FALSE(claim(path, 2, &error));
  CHECK(error == EEXIST);
}

TEST_CASE("a journal whose first piece is gone keeps its name") {
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("journal");
  for (const char* ending : {".part0007", ".1.kept", ".2.part0003.kept"})
    std::ofstream(path + ending) << "a piece";
  CHECK(claim(path, 9) == 3);
  // Names that only look alike.
  for (const char* ending : {".04", ".20260301", ".old", "4"})
    std::ofstream(path + ending) << "something else";
  CHECK(claim(path, 9) == 4);
}
