// What a configuration that is read again changes, and what is in effect without a restart.
#include "daemon/config/config_changes.h"

#include "daemon/config/load_config.h"
#include "same_config.h"
#include "support/catch.h"

namespace {

using namespace leonav;

DaemonConfig read_config(const std::string& text) { return load_config_text(text, "mine.yaml"); }

}  // namespace

TEST_CASE("changes are told in the order of the reference, by their effective values") {
  const DaemonConfig before =
      read_config("preset: car\njournal:\n  piece_mb: 100\nlog: {level: info}\n");
  CHECK(changes_between(before.source, before.source).empty());
  // A value that is given and that was the default is no change.
  const DaemonConfig after = read_config(
      "preset: car\nlog:\n  level: error\njournal:\n  piece_mb: 50\n  piece_s: 3600\n"
      "gnss:\n  elevation_mask_deg: 7\n");
  const auto changes = changes_between(before.source, after.source);
  REQUIRE(changes.size() == 3);
  CHECK(changes[0].path == "gnss.elevation_mask_deg");
  CHECK(changes[0].after == "7");
  CHECK_FALSE(changes[0].is_reloadable);
  CHECK(changes[1] == ConfigChange{"journal.piece_mb", "100", "50", true});
  CHECK(changes[2] == ConfigChange{"log.level", "info", "error", true});
}

TEST_CASE("a default that follows from the vehicle's kind is a change where the kind is one") {
  const auto changes = changes_between(read_config("vehicle:\n  kind: car\n").source,
                                       read_config("vehicle:\n  kind: boat\n").source);
  REQUIRE(changes.size() > 1);
  for (const ConfigChange& change : changes) CHECK_FALSE(change.is_reloadable);
}

TEST_CASE("a reload changes the reloadable keys, and no others") {
  const DaemonConfig before = read_config("preset: car\n");
  const DaemonConfig after = read_config(
      "preset: car\nlog: {level: warning}\ngnss: {elevation_mask_deg: 7}\n"
      "journal: {outputs: none, flush_interval_s: 2, piece_mb: 50, piece_s: 60, total_mb: 400, "
      "kept_mb: 300}\n");
  DaemonConfig running = before;
  take_reloadable(after, &running);
  const auto changes = changes_between(running.source, after.source);
  REQUIRE(changes.size() == 1);
  CHECK(changes[0].path == "gnss.elevation_mask_deg");
  CHECK(running.log.level == LogLevel::kWarning);
  CHECK(running.journal.kept_mb == 300.0);
  // A reloadable key changes in both: in the typed value and in the list of keys.
  DaemonConfig expected = before;
  expected.log = after.log;
  expected.journal = after.journal;
  CHECK(test::same_config(running, expected));
}
