// Signals to leonavd: SIGHUP, by which it reads its configuration again, and those that end it.
#include <csignal>
#include <filesystem>
#include <string>

#include "support/catch.h"
#include "support/programs/daemon_program.h"

namespace {

using namespace leonav;
using test::write_file;

}  // namespace

TEST_CASE("SIGHUP puts reloadable keys into effect, and names those that need a restart") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile file("vehicle.yaml", "preset: phone_imu\n");
  test::DaemonProgram daemon({"--config", file.path(), "--set", "journal.piece_mb=100"});
  REQUIRE(daemon.says("running; LCM memq://"));
  daemon.signal(SIGHUP);
  CHECK(daemon.says("info: SIGHUP: " + file.path() + " read again, nothing has changed"));

  // The command line goes on to stand above the file.
  write_file(file.path(),
             "preset: phone_imu\ngnss: {elevation_mask_deg: 7}\n"
             "journal: {piece_mb: 50, piece_s: 60}\n");
  daemon.signal(SIGHUP);
  CHECK(daemon.says("info: journal.piece_s: 3600 -> 60: in effect"));
  CHECK(daemon.says("warning: gnss.elevation_mask_deg: "));
  CHECK(daemon.says(" -> 7: needs a restart"));
  CHECK(daemon.text().find("journal.piece_mb") == std::string::npos);

  // A key in effect is logged once; one that needs a restart, at each SIGHUP.
  write_file(file.path(), "preset: phone_imu\njournal: {piece_s: 60}\nlog: {level: error}\n");
  daemon.signal(SIGHUP);
  CHECK(daemon.says("info: log.level: info -> error: in effect"));
  const std::string text = daemon.text();
  CHECK(text.find("piece_s: 60 ->") == std::string::npos);
  CHECK(daemon.stop() == 0);
  CHECK(daemon.text().find("finishing", text.size()) == std::string::npos);  // no news any more
}

TEST_CASE("a configuration with errors changes nothing and says all of them") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile file("vehicle.yaml", "preset: phone_imu\n");
  test::DaemonProgram daemon({"--config", file.path()});
  REQUIRE(daemon.says("running; LCM memq://"));
  write_file(
      file.path(),
      "preset: phone_imu\njournal:\n  piece_s: -1\nlog: {level: error}\nvehicle: {kind: cart}\n");
  daemon.signal(SIGHUP);
  CHECK(daemon.says("error: SIGHUP: the configuration has errors, nothing is changed: "));
  CHECK(daemon.says(file.path() + ":3: journal.piece_s: "));
  CHECK(daemon.says("'cart' is not one of car, "));
  std::filesystem::remove(file.path());
  daemon.signal(SIGHUP);
  CHECK(daemon.says(file.path() + ": is no file that can be read again; restart leonavd"));
  CHECK(daemon.running());
  CHECK(daemon.stop() == 0);
  CHECK(daemon.text().find("SIGTERM: finishing") != std::string::npos);  // the level is as it was
}

TEST_CASE("a configuration nested without end is refused by the thread that reads it again") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile file("vehicle.yaml", "preset: phone_imu\n");
  test::DaemonProgram daemon({"--config", file.path()});
  REQUIRE(daemon.says("running; LCM memq://"));
  write_file(file.path(), std::string(400'000, '['));
  daemon.signal(SIGHUP);
  CHECK(daemon.says("error: SIGHUP: the configuration has errors, nothing is changed: "));
  CHECK(daemon.stop() == 0);
}

TEST_CASE("signals without end neither stop leonavd nor silence it") {
  if (!test::have_programs("leonavd")) return;
  test::DaemonProgram daemon({});
  REQUIRE(daemon.says("running; LCM memq://"));
  for (int i = 0; i < 3000 && !daemon.says_by_now("no solution yet"); ++i) {
    daemon.signal(SIGHUP);
    usleep(1000);
  }
  CHECK(daemon.says("no solution yet"));
  CHECK(daemon.stop() == 0);
}

TEST_CASE("a stop that is asked for twice at a time ends leonavd cleanly") {
  if (!test::have_programs("leonavd")) return;
  test::DaemonProgram daemon({});
  REQUIRE(daemon.says("running; LCM memq://"));
  daemon.signal(SIGSTOP);  // both wait for it then
  daemon.signal(SIGINT);
  daemon.signal(SIGTERM);
  daemon.signal(SIGCONT);
  CHECK(daemon.wait() == 0);
  CHECK(daemon.says_by_now("stopped; "));
}
