// Simulated LEO satellites over the recorded drive, as the papers lay them over theirs.
#include <cstdio>
#include <string>

#include "scenario/recorded_runs.h"

namespace leonav::test {
namespace {

std::string with_leo(const TemporaryFile& place, const std::string& log, int seed) {
  const std::string out = place.beside("with_leo.lcmlog");
  const ProgramRun run = run_program(
      "leonav-sim",
      LEONAV_SOURCE_DIR "/config/scenario/drive_overlay.yaml --set seed=" + std::to_string(seed) +
          " --set satellites.advance_s=" + std::to_string(7001 * seed) + " --overlay " + log +
          " --truth " + shared_data("drive/truth.csv") + " -o " + out);
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  return out;
}

void compare(const std::string& name, const std::string& log, const std::string& truth,
             const std::string& configuration, const std::string& systems, int epochs) {
  const TemporaryFile place("unused", "");
  const auto options = [&](const std::string& chosen) {
    return configuration + " --set 'gnss.systems=[" + chosen + "]'";
  };
  const std::string judge = "--truth " + truth;
  const Errors alone = errors_of(place, log, options(systems), judge);
  for (const int seed : {1, 2}) {
    const Errors with =
        errors_of(place, with_leo(place, log, seed), options(systems + ", leo"), judge);
    std::printf("%s: horizontal RMSE %.3f m, with LEO (seed %d) %.3f m, within 3 sigma %.1f %%\n",
                name.c_str(), alone.rmse, seed, with.rmse, 100.0 * with.within);
    CHECK(with.answered == epochs);
    CHECK(with.rmse < 0.75 * alone.rmse);
  }
}

}  // namespace

TEST_CASE("LEO over the recorded drive: GPS gains by it, with and without an IMU") {
  if (!programs() || !have_shared_data("drive/dataset.yaml")) return;
  const TemporaryFile place("unused", "");
  compare("drive, GPS", imported(place, "drive"), shared_data("drive/truth.csv"), config("phone"),
          "gps", 1985);
  const std::string truth = place.beside("truth.csv");
  compare("drive, GPS, Galileo, semi-real IMU", semi_real_log(place, truth), truth,
          config("phone_imu"), "gps, galileo", 1985);
}

}  // namespace leonav::test
