// A configuration with which no journal could be written is refused, with key and remedy.
#include "daemon/journal/journal_check.h"

#include "daemon/config/load_config.h"
#include "support/catch.h"

namespace {

using namespace leonav;

DaemonConfig with(const std::string& journal) {
  return load_config_text("journal:\n  " + journal + "\n", "vehicle.yaml");
}

}  // namespace

TEST_CASE("a journal.path that ends as the name of a piece is refused, at its line") {
  CHECK_THROWS_WITH(require_journal(with("path: /data/run.kept")),
                    "vehicle.yaml:2: journal.path: 'run.kept' is the name of a later or a kept "
                    "piece of 'run'; give a name that does not end in .kept");
  CHECK_THROWS_WITH(require_journal(with("path: run.1.part0002")),
                    Catch::Matchers::Contains("'run.1'; give a name that does not end in .part "
                                              "and digits"));
  CHECK_THROWS_WITH(require_journal(load_preset("phone_imu", {"journal.path=run.part0003.kept"})),
                    Catch::Matchers::StartsWith("--set journal.path: "));
  for (const char* good : {"run", "run.journal", "run.kept/run.journal", "run.part2", "kept", "''"})
    CHECK_NOTHROW(require_journal(with(std::string("path: ") + good)));
}

TEST_CASE("the longest ending of a piece must fit behind journal.path") {
  CHECK_NOTHROW(require_journal(with("path: /data/" + std::string(231, 'x'))));
  CHECK_THROWS_WITH(require_journal(with("path: /data/" + std::string(232, 'x'))),
                    "vehicle.yaml:2: journal.path: the name is too long, because its pieces have "
                    "up to 24 characters more; at most 231 characters are possible, these are 232");
  std::string path;
  while (path.size() < 4000) path += "/" + std::string(99, 'x');
  CHECK_NOTHROW(require_journal(with("path: " + path + "/" + std::string(70, 'x'))));
  CHECK_THROWS_WITH(require_journal(with("path: " + path + "/" + std::string(71, 'x'))),
                    Catch::Matchers::Contains("the path is too long, because"));
}

TEST_CASE(
    "pieces of less than ten seconds are refused, and read in the configuration of old runs") {
  CHECK(with("{path: run, piece_s: 9.9}").journal.piece_s == 9.9);
  CHECK_THROWS_WITH(
      require_journal(with("{path: run, piece_s: 9.9}")),
      "vehicle.yaml:2: journal.piece_s: must be at least 10, or 0 for pieces of any age");
  CHECK_NOTHROW(require_journal(with("{path: run, piece_s: 10}")));
  CHECK_NOTHROW(require_journal(with("{path: run, piece_s: 0}")));
}

TEST_CASE("a path and an age that no journal can have are told at once, each in its line") {
  CHECK_THROWS_WITH(
      require_journal(with("path: run.kept\n  piece_s: 9")),
      "vehicle.yaml:2: journal.path: 'run.kept' is the name of a later or a kept piece of 'run'; "
      "give a name that does not end in .kept\n"
      "vehicle.yaml:3: journal.piece_s: must be at least 10, or 0 for pieces of any age");
}
