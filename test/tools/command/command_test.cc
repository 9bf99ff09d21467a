// leonav-command and leonavd, in a network namespace of their own: live_test.py does the work. And
// what the program says of a wrong command line.
#include <sys/wait.h>

#include <cstdlib>
#include <iostream>

#include "support/catch.h"
#include "support/programs/program_run.h"

using namespace leonav::test;

TEST_CASE("leonavd with a key does what is signed with it, once, and nothing else", "[command]") {
  if (!have_programs("leonav-command", "leonavd", "leonav-replay")) return;
  if (std::system("command -v lcm-gen >/dev/null && command -v python3 >/dev/null") != 0) {
    std::cout << "SKIPPED: no lcm-gen (package liblcm-bin) or no python3\n";
    return;
  }
  const TemporaryFile folder("unused", "");
  const std::string command = "timeout 900 " LEONAV_SOURCE_DIR
                              "/test/tools/command/live_test.py '" LEONAV_BIN_DIR "' '" +
                              folder.beside("out") + "'";
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) return;  // the script has said that it skips
  CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("a wrong command line of leonav-command is named", "[command]") {
  if (!have_programs("leonav-command")) return;
  for (const char* wrong :
       {"", "stop", "restart heading", "heading", "restart --degrees 3", "restart --sigma 3",
        "heading --degrees 361", "heading --degrees=-1", "heading --degrees 3 --sigma 0",
        "heading --degrees nan", "restart --timeout 0", "restart --timeout long"}) {
    INFO(wrong);
    CHECK(run_program("leonav-command", wrong).exit_code == 2);
  }
  const ProgramRun no_file = run_program("leonav-command", "restart --key-file no/such/file");
  CHECK(no_file.exit_code == 1);
  CHECK_THAT(no_file.err, Catch::Contains("no/such/file: cannot be opened"));
  CHECK_THAT(run_program("leonav-command", "--help").out, Catch::Contains("--key-file FILE"));
}
