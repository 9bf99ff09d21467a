// leonav-spy finds the message types from wherever it is started, and compiles all of them.
#include <filesystem>

#include "support/catch.h"
#include "support/programs/program_run.h"

namespace {

namespace fs = std::filesystem;
using namespace leonav::test;

// In the words of a test's skip; empty: leonav-spy has everything that it compiles with.
std::string missing_package(const ProgramRun& run) {
  const auto install = run.err.find("; install");
  return run.exit_code == 1 && install != std::string::npos ? run.err.substr(0, install) : "";
}

}  // namespace

TEST_CASE("leonav-spy makes the jar of every message type") {
  if (!have_programs("leonav-spy")) return;
  const TemporaryFile place("unused", "");
  const std::string folder = place.beside("spy");
  ::setenv("LEONAV_SPY_ONLY_JAR", "yes", 1);
  ::setenv("LEONAV_SPY_DIR", folder.c_str(), 1);
  const ProgramRun run = run_program("leonav-spy", "");
  ::unsetenv("LEONAV_SPY_ONLY_JAR");
  ::unsetenv("LEONAV_SPY_DIR");
  INFO(run.err);
  if (const std::string missing = missing_package(run); !missing.empty()) {
    std::cout << "SKIPPED (optional): " << missing << '\n';
    return;
  }
  REQUIRE(run.exit_code == 0);
  CHECK(fs::file_size(folder + "/leonav-types.jar") > 1000);
  for (const auto& type : fs::directory_iterator(LEONAV_SOURCE_DIR "/lcmtypes")) {
    if (type.path().extension() != ".lcm") continue;
    INFO(type.path().string());
    CHECK(fs::exists(folder + "/classes/leonav/" + type.path().stem().string() + ".class"));
  }
}
