// leonavd's command line and its journal, as a user or a service manager meets them.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/run_configuration.h"
#include "support/catch.h"
#include "support/programs/daemon_program.h"

namespace {

using namespace leonav;

const std::string kConfig = "--preset phone_imu ";

}  // namespace

TEST_CASE("--lcm-url is judged like lcm.url") {
  if (!test::have_programs("leonavd")) return;
  const auto tcpq = test::run_program("leonavd", kConfig + "--lcm-url tcpq://host");
  CHECK(tcpq.exit_code == 3);
  CHECK(tcpq.err.find("--set lcm.url: tcpq:// ends the process") != std::string::npos);
  const auto empty = test::run_program("leonavd", kConfig + "--lcm-url ''");
  CHECK(empty.exit_code == 3);
  CHECK(empty.err.find("--set lcm.url: must not be empty") != std::string::npos);
  // What every start would refuse, the examination refuses too.
  for (const char* examine : {"", "--check "}) {
    const auto unicast =
        test::run_program("leonavd", examine + kConfig + "--lcm-url udpm://10.0.0.1:7667");
    CHECK(unicast.exit_code == 3);
    CHECK(unicast.err.find("'10.0.0.1' is not a multicast address") != std::string::npos);
  }
}

TEST_CASE("a smoother that cannot keep its deadline on this machine is refused") {
  if (!test::have_programs("leonavd")) return;
  const auto run = test::run_program(
      "leonavd", kConfig +
                     "--lcm-url memq:// --set estimator=smoother --set smoother.solver=ceres --set "
                     "smoother.window=60 "
                     "--set realtime.deadline_smoother_ms=1 --set realtime.deadline_ekf_ms=1");
  CHECK(run.exit_code == 1);  // a service manager tries again: the machine may be quicker then
  CHECK(run.err.find("smoother.window: one iteration over 60 keyframes") != std::string::npos);
  CHECK(run.err.find("shorten the window, lengthen the deadline") != std::string::npos);
}

TEST_CASE("a daemon without LCM touches no journal") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile journal("journal", "the evidence");
  const auto run = test::run_program(
      "leonavd", kConfig + "--lcm-url nowhere:// --journal '" + journal.path() + "'");
  CHECK(run.exit_code == 4);
  CHECK(test::text_of(journal.path()) == "the evidence");
  CHECK_FALSE(std::filesystem::exists(journal.path() + ".1"));
  test::run_program("leonavd",
                    kConfig + "--lcm-url nowhere:// --journal '" + journal.beside("new") + "'");
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
  // The whole configuration in one text, which needs no preset and no override.
  CHECK(configuration->overrides.empty());
  CHECK(configuration->name == "preset phone_imu");
  const DaemonConfig recorded = load_config_text(configuration->text, "journal");
  CHECK_FALSE(recorded.threads.lock_memory);
  CHECK(recorded.lcm.url == "memq://");
  CHECK(recorded.journal.path == journal.path());
  CHECK(recorded.navigator == load_preset("phone_imu").navigator);
  CHECK(effective_text(load_preset("phone_imu").source).find("preset:") == std::string::npos);
}

TEST_CASE("the log names the pieces that are kept of a run that crashed") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("run.journal");
  {
    test::DaemonProgram daemon({"--journal", path});
    REQUIRE(daemon.says("no solution yet"));
    daemon.signal(SIGKILL);
    CHECK(daemon.stop() == 128 + SIGKILL);
  }
  test::DaemonProgram daemon({"--journal", path});
  CHECK(daemon.says("journal: " + path + ".kept is kept"));
  CHECK(daemon.says("journal " + path + " exists and is kept; writing " + path + ".1"));
  CHECK(daemon.stop() == 0);
}

TEST_CASE("a service whose journal cannot be written starts, and says so") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("later/run.journal");
  test::DaemonProgram daemon({"--journal", path});
  REQUIRE(daemon.says("running; LCM memq://"));
  CHECK(daemon.says("journal (" + path + ": cannot be written: No such file"));
  std::filesystem::create_directory(folder.beside("later"));
  CHECK(daemon.says("journal: written again, in piece 1"));
  CHECK(daemon.stop() == 0);
  CHECK(std::filesystem::exists(path));
}

TEST_CASE("a journal that can never be written is told at once") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile file("file", "");
  const auto start = [&](const std::string& path) {
    return test::run_program("leonavd", kConfig + "--lcm-url memq:// --journal '" + path + "'");
  };
  const auto inside = start(file.path() + "/run.journal");
  CHECK(inside.exit_code == 5);
  CHECK(inside.err.find("run.journal: cannot be created: Not a directory") != std::string::npos);
  const auto kept = start(file.beside("run.kept"));
  CHECK(kept.exit_code == 3);
  CHECK(kept.err.find("--set journal.path: 'run.kept' is the name of") != std::string::npos);
}

TEST_CASE("what a run needs beyond a good configuration is told with all other errors") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile file("vehicle.yaml",
                                 "preset: car\njournal: {path: x.kept, piece_s: 5, piece: 1}\n"
                                 "commands: {key_file: /nowhere/key}\n");
  for (const char* run : {"--config '", "--check '"}) {
    const auto refused = test::run_program("leonavd", run + file.path() + "' --lcm-url memq://");
    CHECK(refused.exit_code == 3);
    for (const char* wrong :
         {":2: journal.piece: unknown key", ":2: journal.path: 'x.kept' is the name of",
          ":2: journal.piece_s: must be at least 10", ":3: commands.key_file: /nowhere/key"})
      CHECK_THAT(refused.err, Catch::Contains(file.path() + wrong));
  }
}

TEST_CASE("leonavd --check prints the effective configuration, or says what is wrong") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile file("vehicle.yaml",
                                 "preset: car\nvehicle:\n  lever_arm_b_m: [0.4, -0.2, -1.1]\n");
  const auto good = test::run_program("leonavd", "--check '" + file.path() + "'");
  CHECK(good.exit_code == 0);
  CHECK(good.err.find(file.path() + ": good") != std::string::npos);
  const DaemonConfig again = load_config_text(good.out, "printed");
  CHECK(again.navigator == load_config(file.path()).navigator);
  CHECK(good.out.find("# from: " + file.path() + ":3\n") != std::string::npos);

  const auto changes = test::run_program(
      "leonavd", "--check --changes --config '" + file.path() + "' --set gnss.systems=[gps]");
  CHECK(changes.exit_code == 0);
  CHECK(changes.out.find("  systems: [gps] ") != std::string::npos);
  CHECK(changes.out.size() < good.out.size() / 3);
  CHECK(test::run_program("leonavd", "--check --preset urban").exit_code == 0);

  const auto wrong =
      test::run_program("leonavd", "--check '" + file.path() + "' --set vehicle.kind=cart");
  CHECK(wrong.exit_code == 3);
  CHECK(wrong.out.empty());
  CHECK(wrong.err.find("--set vehicle.kind: 'cart' is not one of car, ") != std::string::npos);
  CHECK(test::run_program("leonavd", "--check").exit_code == 2);
  CHECK(test::run_program("leonavd", "--check --preset car '" + file.path() + "'").exit_code == 2);
  CHECK(test::run_program("leonavd", "--changes --preset car").exit_code == 2);
}

TEST_CASE("leonavd --check refuses a journal that cannot be written, at its lines") {
  if (!test::have_programs("leonavd")) return;
  const auto check = [](const std::string& journal) {
    const test::TemporaryFile file("vehicle.yaml", "preset: car\njournal:\n" + journal);
    return test::run_program("leonavd", "--check '" + file.path() + "'");
  };
  const auto bad = check("  path: run.kept\n  piece_s: 9\n");
  CHECK(bad.exit_code == 3);
  CHECK(bad.out.empty());
  CHECK(bad.err.find("vehicle.yaml:3: journal.path: 'run.kept' is the name of a later or a kept "
                     "piece of 'run'; give a name that does not end in .kept\n") !=
        std::string::npos);
  CHECK(bad.err.find("vehicle.yaml:4: journal.piece_s: must be at least 10, or 0 for ") !=
        std::string::npos);
  const auto later = check("  path: run.part0002\n");
  CHECK(later.exit_code == 3);
  CHECK(later.err.find("give a name that does not end in .part and digits") != std::string::npos);
  const auto long_name = check("  path: " + std::string(232, 'x') + "\n");
  CHECK(long_name.exit_code == 3);
  CHECK(long_name.err.find("the name is too long") != std::string::npos);
  // Without a journal its other keys are not judged, and a check creates none.
  CHECK(check("  piece_s: 9\n").exit_code == 0);
  const test::TemporaryFile folder("unused", "");
  const std::string path = folder.beside("run.journal");
  CHECK(check("  path: " + path + "\n").exit_code == 0);
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("leonavd --reference prints every key") {
  if (!test::have_programs("leonavd")) return;
  const auto run = test::run_program("leonavd", "--reference");
  CHECK(run.exit_code == 0);
  CHECK(run.out == test::text_of(LEONAV_SOURCE_DIR "/config/reference.yaml"));
}

TEST_CASE("a journal that nobody takes holds up neither the start nor the end of the service") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile folder("unused", "");
  const std::string pipe = folder.beside("pipe");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  REQUIRE(reader >= 0);
  fcntl(reader, F_SETPIPE_SZ, 4096);  // less than the configuration that a journal begins with
  test::DaemonProgram daemon({"--journal", pipe});
  REQUIRE(daemon.says("running; LCM memq://"));
  CHECK(daemon.says("journal: the disk does not answer"));
  CHECK(daemon.stop() == 5);
  CHECK(daemon.text().find(pipe + ": the disk has not taken the end of the journal") !=
        std::string::npos);
  close(reader);
}
