// leonavd over real LCM multicast, in a network namespace of its own: live_test.sh does the work.
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/synthetic_drive.h"
#include "support/temporary_file.h"

namespace {

using namespace leonav;

void write_log(const std::string& path) {
  test::SyntheticDriveOptions options;
  options.duration_s = 40.0;
  const test::SyntheticDrive drive = test::synthetic_drive(options);
  EventLogWriter log(path);
  Encoder encoder;
  std::uint64_t count = 0;
  std::int64_t time_us = 1'000'000;
  const auto write = [&](Channel channel, ByteSpan bytes) {
    REQUIRE(log.write(time_us, channel_name(channel), bytes));
  };
  test::feed(
      drive, 0.06,
      [&](const Ephemeris& e) { write(Channel::kEphemeris, encoder.encode(e, ++count)); },
      [&](const ImuSample& s) {
        time_us += 5000;
        write(Channel::kImu, encoder.encode(s, ++count));
      },
      [&](const RawEpoch& e) { write(Channel::kGnssEpoch, encoder.encode(e, ++count)); });
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
  const std::string command = "timeout 120 " LEONAV_SOURCE_DIR "/test/daemon/live_test.sh '" + bin +
                              "' " LEONAV_SOURCE_DIR "/config/drive_ins.yaml '" +
                              folder.beside("drive.lcmlog") + "' '" + folder.beside("out") + "' 10";
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) return;  // the script has said that it skips
  CHECK(WEXITSTATUS(status) == 0);
}
