// leonav-serve from LCM to its readers, in a network namespace of its own: live_test.py does the
// work. And what the program says of a wrong command line.
#include <sys/wait.h>

#include <cstdlib>
#include <iostream>

#include "support/catch.h"
#include "support/programs/program_run.h"

using namespace leonav::test;

TEST_CASE("Clients and terminals get every sentence, a slow one is told", "[serve]") {
  if (!have_programs("leonav-serve")) return;
  if (std::system("command -v lcm-gen >/dev/null && command -v python3 >/dev/null") != 0) {
    std::cout << "SKIPPED: no lcm-gen (package liblcm-bin) or no python3\n";
    return;
  }
  const TemporaryFile folder("unused", "");
  const std::string command = "timeout 300 " LEONAV_SOURCE_DIR
                              "/test/tools/serve/live_test.py '" LEONAV_BIN_DIR "' '" +
                              folder.beside("out") + "'";
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) return;  // the script has said that it skips
  CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("A wrong command line of leonav-serve ends with its own code", "[serve]") {
  if (!have_programs("leonav-serve")) return;
  CHECK(run_program("leonav-serve", "").exit_code == 2);
  CHECK(run_program("leonav-serve", "--tcp port").exit_code == 2);
  CHECK(run_program("leonav-serve", "/no/such/file.yaml").exit_code == 3);
  CHECK(run_program("leonav-serve", "--rate 1000 --tcp 1").exit_code == 3);
  CHECK(run_program("leonav-serve", "--check " LEONAV_SOURCE_DIR "/config/serve.yaml").exit_code ==
        0);
  const ProgramRun help = run_program("leonav-serve", "--help");
  CHECK(help.exit_code == 0);
  CHECK_THAT(help.out, Catch::Contains("gpsd -N"));
}
