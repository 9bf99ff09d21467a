// leonav-connect from pseudo-terminals to LCM, in a network namespace of its own: live_test.py and
// sources_live_test.py do the work. And what the program says of a wrong command line.
#include <sys/wait.h>

#include <cstdlib>
#include <iostream>
#include <string>

#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/recorded/shared_data.h"

using namespace leonav::test;

namespace {

// A script that skips ends with 77, and has said why.
void require_success(const std::string& command) {
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) return;
  CHECK(WEXITSTATUS(status) == 0);
}

// Runs a script with the programs' folder and one for what it writes.
void run_script(const std::string& path, const std::string& words = "") {
  if (std::system("command -v lcm-logger >/dev/null && command -v python3 >/dev/null") != 0) {
    std::cout << "SKIPPED: no lcm-logger (package liblcm-bin) or no python3\n";
    return;
  }
  const TemporaryFile folder("unused", "");
  require_success("timeout 600 python3 -B " LEONAV_SOURCE_DIR "/" + path +
                  " '" LEONAV_BIN_DIR "' '" + folder.beside("out") + "' " + words);
}

}  // namespace

TEST_CASE("What arrives live is what the importer makes of the same bytes", "[connect]") {
  if (!have_programs("leonav-connect", "leonav-import", "leonav-sim")) return;
  run_script("test/tools/connect/live_test.py");
}

TEST_CASE("A caster, clients and datagrams are read and recorded to the last byte", "[connect]") {
  if (!have_programs("leonav-connect")) return;
  run_script("test/tools/connect/sources_live_test.py");
}

TEST_CASE("A name server that is mute holds up its own stream alone", "[connect]") {
  if (!have_programs("leonav-connect")) return;
  run_script("test/tools/connect/name_server_test.py");
}

TEST_CASE("Faults of the wire are told, bridged and replayed", "[connect]") {
  if (!have_programs("leonav-connect", "leonavd", "leonav-replay", "leonav-sim")) return;
  run_script("tools/scripts/lib/wire_faults.py",
             "--jobs 6 short-flips short-baud short-restart short-mixed");
}

TEST_CASE("The encoders of receivers' bytes for tests write what independent packages read",
          "[connect]") {
  if (!have_shared_data("station")) return;
  const char* python = std::getenv("LEONAV_PYTHON");
  const std::string command = std::string("'") + (python != nullptr ? python : "python3") +
                              "' -B " LEONAV_SOURCE_DIR "/test/tools/connect/";
  for (const std::string script : {"rtcm3_bytes_test.py", "receiver_bytes_test.py"}) {
    require_success(command + script + " '" + shared_data("station") + "'");
  }
}

TEST_CASE("A wrong command line or configuration ends with its own code", "[connect]") {
  if (!have_programs("leonav-connect")) return;
  CHECK(run_program("leonav-connect", "").exit_code == 2);
  CHECK(run_program("leonav-connect", "--no-such-option").exit_code == 2);
  CHECK(run_program("leonav-connect", "/no/such/file.yaml").exit_code == 3);
  const ProgramRun good =
      run_program("leonav-connect", "--check " LEONAV_SOURCE_DIR "/config/connect.yaml");
  CHECK(good.exit_code == 0);
  CHECK_THAT(good.err, Catch::Contains("good, 2 streams"));
  const ProgramRun help = run_program("leonav-connect", "--help");
  CHECK(help.exit_code == 0);
  CHECK_THAT(help.out, Catch::Contains("format: ubx"));
}
