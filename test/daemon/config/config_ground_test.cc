// Ocean loading and polar motion in the configuration; what a file said stays with the journal.
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <thread>

#include "config_error.h"
#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "daemon/engine/engine.h"
#include "discard.h"
#include "drivers/lcm/event_log.h"
#include "drivers/lcm/run_configuration.h"
#include "same_config.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/temporary_file.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;
using leonav::test::error_of;
using test::Discard;

const std::string kBlq =
    "  BRUX 13101M010\n"
    "  .00352 .00123 .00080 .00032 .00187 .00112 .00063 .00003 .00082 .00044 .00037\n"
    "  .00144 .00035 .00035 .00008 .00053 .00049 .00018 .00009 .00012 .00005 .00006\n"
    "  .00086 .00023 .00023 .00006 .00029 .00028 .00010 .00007 .00004 .00002 .00001\n"
    "   -64.7  -52.0  -96.2  -55.2  -58.8 -151.4  -65.6 -138.1    8.4    5.2    2.1\n"
    "    85.5  114.5   56.5  113.6   99.4   19.1   94.1  -10.4 -167.4 -170.0 -177.7\n"
    "   109.5  147.0   92.7  148.8   50.5  -55.1   36.4 -170.4  -15.0    2.3    5.2\n"
    "$$ END TABLE\n";

std::string with_file(const std::string& path, const std::string& station) {
  return "gnss:\n  ocean_loading_file: \"" + path + "\"\n  ocean_loading_station: " + station +
         "\n";
}

GnssConfig gnss_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return load_config_text(text, "x", overrides).navigator.gnss;
}

std::string sixty_six(const std::string& last) {
  std::string list;
  for (int i = 0; i < 65; ++i) list += std::to_string(i) + "e-2, ";
  return "[" + list + last + "]";
}

bool same_bits(const GnssConfig& a, const GnssConfig& b) {
  return a.ocean_loading && b.ocean_loading &&
         a.ocean_loading->amplitude_m == b.ocean_loading->amplitude_m &&
         a.ocean_loading->phase == b.ocean_loading->phase;
}

}  // namespace

TEST_CASE("without the keys nothing but the solid tide moves the ground") {
  for (const char* text : {"gnss:\n  systems: [gps]\n",
                           "gnss:\n  ocean_loading_file: \"\"\n  ocean_loading_coefficients: []\n"
                           "  polar_motion_x_arcsec: ~\n  polar_motion_y_arcsec: ~\n"}) {
    CHECK_FALSE(gnss_of(text).ocean_loading.has_value());
    CHECK_FALSE(gnss_of(text).polar_motion.has_value());
  }
}

TEST_CASE("polar motion is both or neither; zero is a place of the pole") {
  const GnssConfig given =
      gnss_of("gnss:\n  polar_motion_x_arcsec: 0.1\n  polar_motion_y_arcsec: -0.36\n");
  REQUIRE(given.polar_motion.has_value());
  CHECK(given.polar_motion->xp == Approx(0.1 / 3600.0 * std::numbers::pi / 180.0));
  CHECK(given.polar_motion->yp == Approx(-1e-4 * std::numbers::pi / 180.0));
  CHECK(gnss_of("gnss:\n  polar_motion_x_arcsec: 0\n  polar_motion_y_arcsec: 0\n")
            .polar_motion.has_value());
  CHECK(error_of("gnss:\n  polar_motion_y_arcsec: 0.3\n") ==
        "car.yaml:2: gnss.polar_motion_y_arcsec: is given without x; give both or neither");
  CHECK_THAT(error_of("gnss:\n  polar_motion_x_arcsec: 300\n"),
             Catch::Contains("must be between -1 and 1"));
}

TEST_CASE("a file of ocean loading is read when the configuration is") {
  const test::TemporaryFile blq("station.blq", kBlq);
  const GnssConfig gnss = gnss_of(with_file(blq.path(), "brux"));
  REQUIRE(gnss.ocean_loading.has_value());
  CHECK(gnss.ocean_loading->amplitude_m(0, OceanLoading::kM2) == 0.00352);
  CHECK(gnss.ocean_loading->phase(2, OceanLoading::kSsa) == Approx(5.2 * std::numbers::pi / 180));
  CHECK(same_bits(gnss,
                  gnss_of("gnss: {}\n", {text_override("gnss.ocean_loading_file", blq.path())})));
}

TEST_CASE("what is wrong with ocean loading is said at the key, with the file's line") {
  const test::TemporaryFile blq("station.blq", kBlq);
  const test::TemporaryFile damaged("station.blq", kBlq.substr(0, 300));
  CHECK(error_of(with_file(blq.path(), "ONSA")) ==
        "car.yaml:2: gnss.ocean_loading_file: " + blq.path() +
            ": station 'ONSA' is not in the file; there is 'BRUX 13101M010'");
  CHECK_THAT(error_of(with_file(damaged.path(), "BRUX")),
             Catch::StartsWith("car.yaml:2: gnss.ocean_loading_file: " + damaged.path() + ":5: "));
  CHECK_THAT(error_of(with_file("no/such.blq", "BRUX")), Catch::Contains("cannot be opened"));
  CHECK_THAT(error_of("gnss: {}\n", {"gnss.ocean_loading_file=no/such.blq"}),
             Catch::StartsWith("--set gnss.ocean_loading_file: no/such.blq: cannot be opened"));
  CHECK(error_of("gnss:\n  ocean_loading_station: BRUX\n") ==
        "car.yaml:2: gnss.ocean_loading_station: is of no use without ocean_loading_file");
  const std::string key = "gnss:\n  ocean_loading_coefficients: ";
  CHECK_THAT(error_of(key + "[1, 2, 3]\n"), Catch::Contains("66; there are 3"));
  CHECK_THAT(error_of(key + "0.1\n"), Catch::Contains("expected a list of numbers"));
  CHECK_THAT(error_of(key + "[0.1, x]\n"), Catch::Contains("'x' is not a number"));
  CHECK_THAT(error_of(key + sixty_six("361") + "\n"), Catch::Contains("361 is out of range"));
  // The amplitudes are the first 33, up to 0.5 m.
  CHECK_THAT(error_of(key + "[" + std::string("0.6, ") + sixty_six("1").substr(1) + "\n"),
             Catch::Contains("66; there are 67"));
  CHECK_THAT(error_of(key + "[0.6, " + sixty_six("1").substr(7) + "\n"),
             Catch::Contains("number 1 is no amplitude"));
  CHECK_THAT(error_of(with_file(blq.path(), "BRUX"),
                      {"gnss.ocean_loading_coefficients=" + sixty_six("1")}),
             Catch::Contains("given beside ocean_loading_coefficients; clear one"));
}

TEST_CASE("a recorded configuration needs the file of ocean loading no more") {
  std::unique_ptr<test::TemporaryFile> blq =
      std::make_unique<test::TemporaryFile>("station.blq", kBlq);
  const std::string path = blq->path();
  const DaemonConfig live = load_config_text(with_file(path, "BRUX"), "x", {"gnss.systems=[gps]"});
  const std::string recorded = effective_text(live.source);
  CHECK_THAT(recorded, Catch::Contains("systems: [gps] ") &&
                           Catch::Contains("ocean_loading_coefficients: [0.00352, 0.00123, ") &&
                           !Catch::Contains(path));
  blq.reset();
  CHECK_THAT(error_of(with_file(path, "BRUX")), Catch::Contains("cannot be opened"));
  const DaemonConfig again = load_config_text(recorded, "x");
  CHECK(same_bits(live.navigator.gnss, again.navigator.gnss));
  CHECK(test::same_config(live, again));
  // Another file in its place, or none.
  CHECK_FALSE(gnss_of(recorded, {"gnss.ocean_loading_coefficients=[]"}).ocean_loading.has_value());
}

TEST_CASE("a journal of a run with ocean loading and polar motion verifies without the file") {
  const std::string replay = LEONAV_BIN_DIR "/leonav-replay";
  if (!std::filesystem::exists(replay)) {
    std::cout << "SKIPPED: " << replay << " is not built\n";
    return;
  }
  const test::TemporaryFile folder("unused", "");
  {
    const test::TemporaryFile blq("station.blq", kBlq);
    DaemonConfig config = load_preset(
        "phone_imu", {"vehicle.lever_arm_b_m=[0.4, -0.2, -1.1]",
                      text_override("gnss.ocean_loading_file", blq.path()),
                      "gnss.polar_motion_x_arcsec=0.1", "gnss.polar_motion_y_arcsec=0.4"});
    config.threads = ThreadsConfig();
    config.threads.lock_memory = false;
    config.journal.path = folder.beside("journal.lcmlog");
    Discard target;
    Engine engine(config, &target);
    engine.start();
    test::feed_messages(test::synthetic_drive(test::noisy_drive(15.0)),
                        [&](Channel channel, ByteSpan bytes) {
                          engine.receive(channel, bytes, 1);
                          if (channel != Channel::kGnssEpoch) return;
                          while (!engine.idle()) test::wait_a_moment();
                        });
    REQUIRE(engine.finish());
  }
  const auto verify = [&](const std::string& options) {
    return std::system((replay + " --verify " + options + " --out '" + folder.beside("replay") +
                        "' '" + folder.beside("journal.lcmlog") + "' >'" + folder.beside("text") +
                        "' 2>&1")
                           .c_str());
  };
  CHECK(verify("") == 0);
  // The coefficients matter: without them the outputs are others.
  CHECK(verify("--set gnss.ocean_loading_coefficients=[]") != 0);
}
