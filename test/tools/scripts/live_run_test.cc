// tools/scripts/lib/live-run does not take a run for good in which the daemon heard nothing, or not
// all.
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/programs/program_run.h"

using namespace leonav;
using namespace leonav::test;

namespace {

void write_log(const std::string& path, int imu, int epochs) {
  EventLogWriter log(path);
  const std::uint8_t bytes[] = {1, 2, 3, 4};
  for (int i = 0; i < imu; ++i) REQUIRE(log.write(i + 1, "LEONAV_IMU", bytes));
  for (int i = 0; i < epochs; ++i) REQUIRE(log.write(imu + i + 1, "LEONAV_GNSS_EPOCH", bytes));
  REQUIRE(log.write(imu + epochs + 1, "LEONAV_SOLUTION", bytes));  // no input
  REQUIRE(log.flush());
}

void write_script(const std::string& path, const std::string& text) {
  std::ofstream(path) << "#!/bin/bash\n" << text;
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
}

ProgramRun live_run(const TemporaryFile& place) {
  const std::string out = place.beside("out"), err = place.beside("err");
  const std::string bin = std::filesystem::path(place.path()).parent_path();
  const std::string command = "LEONAV_START_WAIT_S=1 PATH='" + bin + "':$PATH timeout 30 " +
                              LEONAV_SOURCE_DIR "/tools/scripts/lib/live-run '" + bin + "' none '" +
                              place.beside("log") + "' '" + place.beside("journal") + "' 1 >'" +
                              out + "' 2>'" + err + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, text_of(out), text_of(err)};
}

}  // namespace

TEST_CASE("a live run whose daemon does not listen, or misses messages, fails") {
  if (std::system("command -v python3 >/dev/null") != 0) {
    std::cout << "SKIPPED: no python3\n";
    return;
  }
  const TemporaryFile place("unused", "");
  write_script(place.beside("lcm-logplayer"), "touch '" + place.beside("played") + "'\n");
  write_log(place.beside("log"), 100, 5);
  // Stands in for the daemon: says `words`, and leaves a journal that was prepared.
  const auto daemon = [&](const std::string& words, int imu, int epochs) {
    write_log(place.beside("heard"), imu, epochs);
    write_script(place.beside("leonavd"), "trap \"cp '" + place.beside("heard") + "' '" +
                                              place.beside("journal") + "'; exit 0\" TERM\necho '" +
                                              words + "' >&2\nwhile :; do sleep 0.1; done\n");
    std::filesystem::remove(place.beside("played"));
    return live_run(place);
  };
  const ProgramRun good = daemon("running; LCM udpm", 100, 5);
  CAPTURE(good.err);
  CHECK(good.exit_code == 0);
  const ProgramRun deaf = daemon("waiting", 100, 5);
  CHECK(deaf.exit_code == 1);
  CHECK_THAT(deaf.err, Catch::Contains("did not say that it listens"));
  CHECK_FALSE(std::filesystem::exists(place.beside("played")));
  const ProgramRun lossy = daemon("running; LCM udpm", 99, 5);
  CHECK(lossy.exit_code == 1);
  CHECK_THAT(lossy.err, Catch::Contains("< LEONAV_IMU 100") && Catch::Contains("> LEONAV_IMU 99"));
}
