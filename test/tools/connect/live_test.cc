// leonav-connect from pseudo-terminals to LCM, in a network namespace of its own: live_test.py and
// sources_live_test.py do the work. And what the program says of a wrong command line.
#include <sys/wait.h>

#include <cstdlib>
#include <iostream>
#include <string>

#include "support/catch.h"
#include "support/program_run.h"

using namespace leonav::test;

namespace {

// Runs a script of this folder, which skips with 77.
void run_script(const std::string& name) {
  if (std::system("command -v lcm-logger >/dev/null && command -v python3 >/dev/null") != 0) {
    std::cout << "SKIPPED: no lcm-logger (package liblcm-bin) or no python3\n";
    return;
  }
  const TemporaryFile folder("unused", "");
  const std::string command = "timeout 600 " LEONAV_SOURCE_DIR "/test/tools/connect/" + name +
                              " '" LEONAV_BIN_DIR "' '" + folder.beside("out") + "'";
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) return;  // the script has said that it skips
  CHECK(WEXITSTATUS(status) == 0);
}

}  // namespace

TEST_CASE("What arrives live is what the importer makes of the same bytes", "[connect]") {
  if (!have_programs("leonav-connect", "leonav-import", "leonav-sim")) return;
  run_script("live_test.py");
}

TEST_CASE("A caster, clients and datagrams are read and recorded to the last byte", "[connect]") {
  if (!have_programs("leonav-connect")) return;
  run_script("sources_live_test.py");
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
