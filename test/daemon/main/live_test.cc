// leonavd over real LCM multicast, in a network namespace of its own: live_test.sh does the work.
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/temporary_file.h"

namespace {

using namespace leonav;

void write_log(const std::string& path) {
  EventLogWriter log(path);
  std::int64_t time_us = 1'000'000;
  test::feed_messages(test::synthetic_drive(test::noisy_drive(40.0)),
                      [&](Channel channel, ByteSpan bytes) {
                        if (channel == Channel::kImu) time_us += 5000;
                        REQUIRE(log.write(time_us, channel_name(channel), bytes));
                      });
  REQUIRE(log.flush());
}

}  // namespace

TEST_CASE("a live run over multicast replays byte for byte") {
  const std::string bin = LEONAV_BIN_DIR;
  for (const char* program : {"/leonavd", "/leonav-replay"}) {
    if (!std::filesystem::exists(bin + program)) {
      std::cout << "SKIPPED: " << bin << program << " is not built\n";
      return;
    }
  }
  if (std::system("command -v lcm-logplayer >/dev/null") != 0) {
    std::cout << "SKIPPED: no lcm-logplayer (package liblcm-bin)\n";
    return;
  }
  const test::TemporaryFile folder("unused", "");
  write_log(folder.beside("drive.lcmlog"));
  const std::string command = "timeout 120 " LEONAV_SOURCE_DIR "/test/daemon/main/live_test.sh '" +
                              bin + "' phone_imu '" + folder.beside("drive.lcmlog") + "' '" +
                              folder.beside("out") + "' 10";
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) return;  // the script has said that it skips
  CHECK(WEXITSTATUS(status) == 0);
}
