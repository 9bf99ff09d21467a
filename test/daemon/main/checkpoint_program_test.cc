// leonavd's log says what it makes of the checkpoint's file.
#include <string>

#include "core/earth/ellipsoid.h"
#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/text/checkpoint_text.h"
#include "support/catch.h"
#include "support/programs/daemon_program.h"

namespace {

using namespace leonav;

std::vector<std::string> with_checkpoint(const std::string& path) {
  return {"--set", "checkpoint.path=" + path};
}

}  // namespace

TEST_CASE("a daemon without a checkpoint yet, with a good one, with a damaged one") {
  if (!test::have_programs("leonavd")) return;
  const test::TemporaryFile damaged("damaged.yaml", "gps_week: 23");
  test::DaemonProgram fresh(with_checkpoint(damaged.beside("absent.yaml")));
  CHECK(fresh.says("info: no checkpoint " + damaged.beside("absent.yaml") + " to begin from"));
  CHECK(fresh.stop() == 0);

  test::DaemonProgram warned(with_checkpoint(damaged.path()));
  CHECK(warned.says("warning: checkpoint ignored: " + damaged.path() + ": is damaged"));
  CHECK(warned.says("running"));
  CHECK(warned.stop() == 0);
  CHECK(test::text_of(damaged.path()) == "gps_week: 23");  // a run without a heading leaves it

  Checkpoint checkpoint;
  checkpoint.time = GpsTime::from_week_and_tow(2300, 1000.0);
  checkpoint.antenna_p_e = to_ecef({0.69, 0.14, 300.0});
  checkpoint.antenna_sigma = 1.0;
  checkpoint.heading_sigma = 0.01;
  checkpoint.gyro_bias_sigma = 1e-5;
  REQUIRE(save_checkpoint(damaged.beside("good.yaml"), checkpoint).empty());
  test::DaemonProgram good(with_checkpoint(damaged.beside("good.yaml")));
  CHECK(good.says("info: checkpoint " + damaged.beside("good.yaml") + " read"));
  CHECK(good.stop() == 0);
}

TEST_CASE("the keys of checkpoint are judged") {
  if (!test::have_programs("leonavd")) return;
  const std::string config = "--preset phone_imu ";
  for (const char* key :
       {"checkpoint.interval_s=0", "checkpoint.max_age_s=-1", "checkpoint.interval=3"}) {
    const auto run = test::run_program("leonavd", config + "--set " + key);
    CHECK(run.exit_code == 3);
    CHECK(run.err.find("--set checkpoint.") != std::string::npos);
  }
}

TEST_CASE("what became of a checkpoint is said in words") {
  CHECK(checkpoint_text(CheckpointUse::kElsewhere, 100.04) ==
        "checkpoint ignored: the vehicle stands 100.0 m from its position");
  CHECK(checkpoint_text(CheckpointUse::kUsed, 1.0).find("checkpoint used") == 0);
  CHECK(checkpoint_text(CheckpointUse::kOld, 40.0 * 86400.0).find("40.0 days") !=
        std::string::npos);
  CHECK(checkpoint_text(CheckpointUse::kCalibrationUsed, 5400.0) ==
        "calibration of 1.5 hours ago used");
  CHECK(checkpoint_text(CheckpointUse::kCalibrationOld, -5.0) ==
        "calibration ignored: 5.0 s later than the measurements");
  CHECK(checkpoint_text(CheckpointUse::kCalibrationMounted, 0.0).find("mounting_rpy_deg") !=
        std::string::npos);
  CHECK(checkpoint_text(CheckpointUse::kCalibrationImu, 6.0).find("6.0 sigma") !=
        std::string::npos);
}
