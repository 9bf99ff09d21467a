// Whatever memory leonavd is given, it runs or it says why not, and SIGTERM ends it.
#include <iostream>
#include <regex>
#include <string>

#include "support/catch.h"
#include "support/programs/program_run.h"

namespace {

using namespace leonav;

}  // namespace

TEST_CASE("a leonavd without enough memory says so and ends; SIGTERM ends every other one") {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  std::cout << "SKIPPED: sanitizers need terabytes of addresses\n";
  return;
#endif
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile place("unused", "");
  bool has_run = false;
  for (const int megabytes : {48, 64, 80, 96, 112, 128, 160, 192, 256, 384, 1024}) {
    const std::string err = place.beside("err");
    // SIGTERM after 3 s, SIGKILL 20 s later.
    const std::string command = "ulimit -v " + std::to_string(megabytes * 1024) +
                                "; timeout --foreground -k 20 --preserve-status 3 '" LEONAV_BIN_DIR
                                "/leonavd' --preset urban --lcm-url memq:// --set "
                                "vehicle.kind=car --set estimator=smoother --journal '" +
                                place.beside("run.journal") + "' 2>'" + err + "'";
    const int status = std::system(("sh -c \"" + command + "\"").c_str());
    const std::string text = test::text_of(err);
    INFO(megabytes << " MB: " << text);
    REQUIRE(WIFEXITED(status));
    const int code = WEXITSTATUS(status);
    const bool runs = text.find("running; LCM") != std::string::npos;
    has_run = has_run || runs;
    if (runs) {
      CHECK(code == 0);
      continue;
    }
    CHECK_FALSE(has_run);  // more memory is never worse
    // 143: still beginning when the signal came; 127: not even its libraries find room.
    CHECK((code == 1 || code == 4 || code == 127 || code == 143));
    if (code != 143) CHECK(std::regex_search(text, std::regex("memory|cannot start thread|map")));
  }
  CHECK(has_run);
}
