// leonav-smooth as a user runs it.
#include <algorithm>
#include <cmath>

#include "drivers/csv/solution_csv.h"
#include "drivers/lcm/event_log.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"
#include "support/programs/program_run.h"

namespace leonav::test {
namespace {

using Catch::Contains;

// Errors that the drive has: white, 0.5 m of a code.
const std::string kCar =
    "--preset car --set 'vehicle.lever_arm_b_m=[0.4, -0.2, -1.1]' --set ekf.learn_errors=false "
    "--set ekf.doppler_correlation_time_s=0 --set gnss.code_combination=ionosphere_free "
    "--set gnss.gps.code_sigma_m=0.5 --set gnss.galileo.code_sigma_m=0.5 ";

SyntheticDrive drive_of(std::uint64_t seed) {
  SyntheticDriveOptions options = noisy_drive(60.0);
  options.seed = seed;
  options.imu_rate_hz = 100.0;
  options.angle_random_walk = 1e-5;
  options.velocity_random_walk = 1e-4;
  return synthetic_drive(options);
}

const SyntheticDrive& drive() {
  static const SyntheticDrive made = drive_of(1);
  return made;
}

// Without the messages of one channel.
void write_log(const SyntheticDrive& drive, const std::string& path,
               Channel without = Channel::kCommand) {
  EventLogWriter log(path);
  bool good = true;
  feed_messages(drive, [&](Channel channel, ByteSpan bytes) {
    if (channel != without) good = log.write(1, channel_name(channel), bytes) && good;
  });
  REQUIRE(good);
  REQUIRE(log.flush());
}

std::string quoted(const std::string& path) { return "'" + path + "'"; }

// The mean square of the 3D error from a time on.
double mean_square_m2(const SyntheticDrive& drive, const std::string& path, double from_s) {
  double sum = 0.0;
  int count = 0;
  for (const SolutionRow& row : read_solution_csv(path).rows) {
    if (seconds_between(row.pva.time, kSkyEpoch) < from_s) continue;
    sum += (to_ecef(row.pva.position) - drive.truth_at(row.pva.time).p_e).squaredNorm();
    ++count;
  }
  REQUIRE(count > 10);
  return sum / count;
}

}  // namespace

TEST_CASE("leonav-smooth --help states its exit codes") {
  if (!have_programs("leonav-smooth")) return;
  const ProgramRun help = run_program("leonav-smooth", "--help");
  CHECK(help.exit_code == 0);
  CHECK_THAT(help.out, Contains("Exit codes: 0 done; 1 "));
}

TEST_CASE("leonav-smooth refuses a wrong command line with exit code 2") {
  if (!have_programs("leonav-smooth")) return;
  const TemporaryFile place("log", "");
  const std::string rest = "--out " + quoted(place.beside("out")) + " " + quoted(place.path());
  const auto refused = [&](const std::string& arguments, const std::string& named) {
    CAPTURE(arguments);
    const ProgramRun run = run_program("leonav-smooth", arguments);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.err, Contains(named));
  };
  refused("--preset car --solver qr " + rest, "--solver: must be auto, ceres or chain");
  refused("--preset car --rate 0 " + rest, "--rate: must be 0.001 to 1000");
  refused("--preset car --iterations 0 " + rest, "--iterations");
  refused("--preset car --iterations 2.7 " + rest, "--iterations: must be a whole number");
  refused("--preset car --interval -1 " + rest, "--interval");
  refused("--preset car " + quoted(place.path()), "--out");
  refused("--preset car --out " + quoted(place.beside("out")), "expected one log file");
  CHECK_FALSE(std::filesystem::exists(place.beside("out")));
}

TEST_CASE("leonav-smooth names a file in which there is nothing to smooth") {
  if (!have_programs("leonav-smooth")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("bare.lcmlog");
  const auto smooth = [&] {
    return run_program("leonav-smooth",
                       kCar + "--out " + quoted(place.beside("out")) + " " + quoted(log));
  };
  SECTION("an absent one") {
    const ProgramRun run = smooth();
    CHECK(run.exit_code == 1);
    CHECK_THAT(run.err, Contains("bare.lcmlog"));
  }
  SECTION("one without GNSS epochs") {
    write_log(drive(), log, Channel::kGnssEpoch);
    const ProgramRun run = smooth();
    CHECK(run.exit_code == 1);
    CHECK_THAT(run.err, Contains("bare.lcmlog: no LEONAV_GNSS_EPOCH"));
    CHECK_THAT(run.err, Contains("IMU 6000"));
  }
  SECTION("one without ephemerides") {
    write_log(drive(), log, Channel::kEphemeris);
    const ProgramRun run = smooth();
    CHECK(run.exit_code == 1);
    CHECK_THAT(run.err, Contains("bare.lcmlog: the filter found no position"));
  }
  CHECK_FALSE(std::filesystem::exists(place.beside("out/solution.csv")));
}

TEST_CASE("leonav-smooth gives every epoch of a drive, the same by either solver") {
  if (!have_programs("leonav-smooth")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("run.lcmlog");
  write_log(drive(), log);
  const auto smooth = [&](const std::string& solver) {
    return run_program("leonav-smooth", kCar + "--solver " + solver + " --out " +
                                            quoted(place.beside(solver)) + " " + quoted(log));
  };
  const ProgramRun ceres = smooth("ceres"), chain = smooth("chain");
  CAPTURE(ceres.out, ceres.err, chain.out, chain.err);
  REQUIRE(ceres.exit_code == 0);
  REQUIRE(chain.exit_code == 0);
  for (const std::string name :
       {"solution.csv", "forward.csv", "residuals.csv", "summary.txt", "configuration.yaml"}) {
    CAPTURE(name);
    CHECK(std::filesystem::file_size(place.beside("ceres/" + name)) > 0);
    CHECK(std::filesystem::file_size(place.beside("chain/" + name)) > 0);
  }
  CHECK(text_of(place.beside("ceres/summary.txt")) == ceres.out);
  CHECK_THAT(ceres.out, Contains("solver: ceres (as asked for)"));
  CHECK_THAT(ceres.out, Contains("converged: yes"));
  CHECK_THAT(ceres.out, Contains("segments: 1"));
  CHECK(ceres.err.empty());

  const auto rows = read_solution_csv(place.beside("ceres/solution.csv")).rows;
  const auto others = read_solution_csv(place.beside("chain/solution.csv")).rows;
  const std::size_t epochs = drive().epochs.size();
  CHECK(rows.size() <= epochs);
  CHECK(rows.size() >= epochs - 2);  // it starts from the first, and the last waits for its IMU
  REQUIRE(others.size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(rows[i].pva.yaw);  // also before the alignment
    CHECK((to_ecef(rows[i].pva.position) - to_ecef(others[i].pva.position)).norm() < 1e-3);
    CHECK((to_ecef(rows[i].pva.position) - drive().truth_at(rows[i].pva.time).p_e).norm() < 1.0);
  }
}

// The epochs of a drive share most of their error, so that one drive says little.
TEST_CASE("leonav-smooth is nearer to the truth than the filter") {
  if (!have_programs("leonav-smooth", "leonav-replay")) return;
  constexpr int kDrives = 32;
  constexpr double kAligned_s = 20.0;  // before, the filter gives the antenna
  double filter = 0.0, smoothed = 0.0;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    const TemporaryFile place("unused", "");
    const std::string log = place.beside("run.lcmlog");
    const SyntheticDrive one = drive_of(seed);
    write_log(one, log);
    const auto into = [&](const std::string& folder) {
      return "--out " + quoted(place.beside(folder)) + " " + quoted(log);
    };
    REQUIRE(run_program("leonav-replay", kCar + into("filter")).exit_code == 0);
    REQUIRE(run_program("leonav-smooth", kCar + "--solver chain " + into("chain")).exit_code == 0);
    filter += mean_square_m2(one, place.beside("filter/solution.csv"), kAligned_s) / kDrives;
    smoothed += mean_square_m2(one, place.beside("chain/solution.csv"), kAligned_s) / kDrives;
  }
  WARN("rms: filter " << std::sqrt(filter) << " m, smoothed " << std::sqrt(smoothed) << " m");
  CHECK(std::sqrt(smoothed) < 0.95 * std::sqrt(filter));
}

TEST_CASE("at a rate both of two drives in one log have their rows") {
  if (!have_programs("leonav-smooth", "leonav-replay")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("run.lcmlog"), twice = place.beside("twice.lcmlog");
  write_log(drive(), log);
  write_file(twice, text_of(log) + text_of(log));
  for (const std::string program : {"leonav-smooth --solver chain", "leonav-replay"}) {
    CAPTURE(program);
    const auto rows = [&](const std::string& of) {
      const std::string name = program.substr(0, program.find(' '));
      const ProgramRun run =
          run_program(name, program.substr(name.size()) + " " + kCar + "--rate 1 --out " +
                                quoted(place.beside("out")) + " " + quoted(of));
      CAPTURE(run.err);
      CHECK(run.exit_code == 0);
      // Lines: a reader of solutions takes those whose times ascend.
      const std::string table = text_of(place.beside("out/solution.csv"));
      return std::count(table.begin(), table.end(), '\n') - 1;
    };
    const auto once = rows(log);
    REQUIRE(once > 40);
    CHECK(rows(twice) > 2 * once - 10);
  }
}

TEST_CASE("a run of leonav-smooth that fails leaves the tables of an earlier one as they were") {
  if (!have_programs("leonav-smooth")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("run.lcmlog");
  write_log(drive(), log);
  const auto smooth = [&](const std::string& options) {
    return run_program("leonav-smooth", kCar + "--solver chain " + options + "--out " +
                                            quoted(place.beside("out")) + " " + quoted(log));
  };
  REQUIRE(smooth("").exit_code == 0);
  const std::string before = text_of(place.beside("out/configuration.yaml"));
  REQUIRE(smooth("--set gnss.elevation_mask_deg=89 ").exit_code == 1);
  CHECK(text_of(place.beside("out/configuration.yaml")) == before);
}

TEST_CASE("with too few iterations for the IMU to bridge anything leonav-smooth says that alone") {
  if (!have_programs("leonav-smooth")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("run.lcmlog");
  write_log(drive(), log);
  const ProgramRun run =
      run_program("leonav-smooth", kCar + "--solver chain --iterations 1 --out " +
                                       quoted(place.beside("out")) + " " + quoted(log));
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("--iterations 3 or more") && !Contains("inertial connection"));
}

TEST_CASE("leonav-smooth takes a log that is cut short up to there, and says so") {
  if (!have_programs("leonav-smooth")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("run.lcmlog");
  write_log(drive(), log);
  std::filesystem::resize_file(log, std::filesystem::file_size(log) / 2);
  const ProgramRun run =
      run_program("leonav-smooth", kCar + "--solver chain --rate 10 --out " +
                                       quoted(place.beside("out")) + " " + quoted(log));
  CAPTURE(run.out, run.err);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Contains("warning: " + log + ": its last message is cut short"));
  CHECK_THAT(run.err, Contains("its last message is cut short"));
  CHECK_THAT(text_of(place.beside("out/summary.txt")), Contains("its last message is cut short"));
  const std::vector<SolutionRow> rows = read_solution_csv(place.beside("out/solution.csv")).rows;
  CHECK(rows.size() > 100);
  CHECK(rows.size() < 400);
}

}  // namespace leonav::test
