// Journals that earlier versions have written are still read: test/daemon/kept_journals/README.md.
#include <cmath>
#include <string>

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"
#include "drivers/csv/solution_csv.h"
#include "drivers/csv/truth_csv.h"
#include "support/catch.h"
#include "support/has.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"

namespace {

using namespace leonav;
using test::has;

const std::string kFolder = LEONAV_SOURCE_DIR "/test/daemon/kept_journals/";

struct KeptReplay {
  test::ProgramRun run;
  std::string summary, configuration;
  SolutionCsv solution;
};

KeptReplay replay_kept(const std::string& name) {
  const test::TemporaryFile folder("unused", "");
  const std::string out = folder.beside("out");
  KeptReplay replay;
  replay.run = test::run_program("leonav-replay", "--out '" + out + "' '" + kFolder + name + "'");
  INFO(replay.run.err);
  REQUIRE(replay.run.exit_code == 0);
  replay.summary = test::text_of(out + "/summary.txt");
  replay.configuration = test::text_of(out + "/configuration.yaml");
  replay.solution = read_solution_csv(out + "/solution.csv");
  return replay;
}

}  // namespace

TEST_CASE("a journal of version 0.1.0 is read and replays to where the drive has ended") {
  if (!test::have_programs("leonav-replay")) return;
  const KeptReplay replay = replay_kept("leonavd_0_1_0.journal");
  CHECK(has(replay.summary, "configuration: vehicle.yaml as recorded in"));
  for (const char* count :
       {"input IMU: 600\n", "input GNSS_EPOCH: 11\n", "input EPHEMERIS: 42\n",
        "input ANTENNA: 46\n", "deadline misses: 0\n", "smoother decisions in time: 11\n"}) {
    INFO(count);
    CHECK(has(replay.summary, count));
  }
  // Of vehicle.yaml, and of the preset that it names.
  for (const char* key : {"lever_arm_b_m: [0.4, -0.2, -1.1]", "initial_heading_deg: 0", "kind: car",
                          "estimator: smoother"}) {
    INFO(key);
    CHECK(has(replay.configuration, key));
  }

  // In the version that wrote it: 0.58 m, 0.28 m, 0.03 m/s, 0.15 deg.
  const TruthPoint truth = read_truth_csv(kFolder + "truth.csv").points.back();
  REQUIRE(replay.solution.rows.size() == 11);
  const SolutionRow& last = replay.solution.rows.back();
  REQUIRE(last.pva.time == truth.time);
  REQUIRE(last.pva.v_n);
  REQUIRE(last.pva.yaw);
  CHECK(last.source == Source::kSmoother);
  const Eigen::Vector3d error_n =
      rotation_ecef_to_ned(truth.position) * (to_ecef(last.pva.position) - to_ecef(truth.position));
  CHECK(error_n.head<2>().norm() < 1.0);
  CHECK(std::abs(error_n.z()) < 1.0);
  CHECK((*last.pva.v_n - *truth.v_n).norm() < 0.1);
  CHECK(std::abs(*last.pva.yaw - *truth.yaw) < 1.0 * kDegree);
}
