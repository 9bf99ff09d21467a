// leonavd's command line and its journal, as a user or a service manager meets them.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon_program.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/run_configuration.h"
#include "support/catch.h"

namespace {

using namespace leonav;

const std::string kConfig = "--config " LEONAV_SOURCE_DIR "/config/drive_ins.yaml ";

}  // namespace

TEST_CASE("--lcm-url is judged like lcm.url") {
  if (!test::have_programs("leonavd")) return;
  const auto tcpq = test::run_program("leonavd", kConfig + "--lcm-url tcpq://host");
  CHECK(tcpq.exit_code == 3);
  CHECK(tcpq.err.find("--set lcm.url: tcpq:// ends the process") != std::string::npos);
  const auto empty = test::run_program("leonavd", kConfig + "--lcm-url ''");
  CHECK(empty.exit_code == 3);
  CHECK(empty.err.find("--set lcm.url: must not be empty") != std::string::npos);
}

TEST_CASE("a daemon without LCM touches no journal") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile journal("journal", "the evidence");
  const auto run = test::run_program(
      "leonavd", kConfig + "--lcm-url udpm://10.0.0.1:7667 --journal '" + journal.path() + "'");
  CHECK(run.exit_code == 4);
  CHECK(test::text_of(journal.path()) == "the evidence");
  CHECK_FALSE(std::filesystem::exists(journal.path() + ".1"));
  test::run_program("leonavd", kConfig + "--lcm-url udpm://10.0.0.1:7667 --journal '" +
                                   journal.beside("new") + "'");
  CHECK_FALSE(std::filesystem::exists(journal.beside("new")));
}

TEST_CASE("a restarted daemon keeps the journal; the journal holds what the command line changed") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile journal("journal", "the evidence");
  test::DaemonProgram daemon({"--journal", journal.path()});
  REQUIRE(daemon.says("running; LCM memq://"));
  CHECK(daemon.says("journal " + journal.path() + " exists and is kept; writing " + journal.path() +
                    ".1"));
  CHECK(daemon.stop() == 0);
  CHECK(test::text_of(journal.path()) == "the evidence");

  EventLogReader log(journal.path() + ".1");
  LogEvent event;
  REQUIRE(log.next(&event));
  const auto configuration = decode_run_configuration(event.data);
  REQUIRE(configuration.has_value());
  const auto& overrides = configuration->overrides;
  const auto recorded = [&](const std::string& one) {
    return std::count(overrides.begin(), overrides.end(), one) == 1;
  };
  CHECK(recorded("realtime.lock_memory=false"));
  CHECK(recorded("lcm.url=\"memq://\""));
  CHECK(recorded("journal.path=\"" + journal.path() + "\""));
}
