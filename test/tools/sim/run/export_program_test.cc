// leonav-sim --export as a user runs it: through leonav's own importer, and by RTKLIB.
#include <cmath>
#include <filesystem>
#include <fstream>

#include "drivers/csv/solution_csv.h"
#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/recorded/rtklib_single.h"
#include "support/temporary_file.h"

using namespace leonav;

namespace {

std::string quoted(const std::string& path) { return "'" + path + "'"; }

SolutionCsv replayed(
    const test::TemporaryFile& place, const std::string& log,
    const std::string& options = "--set 'gnss.systems=[gps,galileo,beidou,leo]' ") {
  const std::string out = place.beside(log + "_out");
  const auto run =
      test::run_program("leonav-replay", "--preset demo " + options + quoted(place.beside(log)) +
                                             " --out " + quoted(out));
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  return read_solution_csv(out + "/solution.csv");
}

}  // namespace

TEST_CASE("A run's files give the solution that its log gives, to the digits of the formats") {
  if (!test::have_programs("leonav-sim", "leonav-import", "leonav-replay")) return;
  const test::TemporaryFile place("scenario.yaml", "name: short\nduration_s: 90\n");
  const auto sim = test::run_program(
      "leonav-sim", quoted(place.path()) + " -o " + quoted(place.beside("run.lcmlog")) +
                        " --export " + quoted(place.beside("files")));
  INFO(sim.err);
  REQUIRE(sim.exit_code == 0);
  const auto import =
      test::run_program("leonav-import", quoted(place.beside("files/dataset.yaml")) + " -o " +
                                             quoted(place.beside("imported.lcmlog")));
  INFO(import.err);
  REQUIRE(import.exit_code == 0);
  CHECK(import.out.find("damaged") == std::string::npos);
  const SolutionCsv log = replayed(place, "run.lcmlog"), files = replayed(place, "imported.lcmlog");
  REQUIRE(log.rows.size() == files.rows.size());
  REQUIRE(log.rows.size() > 60);
  double worst = 0.0;
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    const TruthPoint &a = log.rows[i].pva, &b = files.rows[i].pva;
    REQUIRE(a.time == b.time);
    worst = std::max(worst, (to_ecef(a.position) - to_ecef(b.position)).norm());
  }
  INFO("worst " << worst << " m");
  CHECK(worst < 0.02);
}

TEST_CASE("Low satellites by elements from a table give the solution within its sigma") {
  if (!test::have_programs("leonav-sim", "leonav-import", "leonav-replay")) return;
  const test::TemporaryFile place(
      "scenario.yaml",
      "duration_s: 120\nimu: {enabled: false}\nreceiver: {lever_arm_b_m: [0, 0, 0]}\n"
      "satellites: {gps: {enabled: false}, galileo: {enabled: false}, beidou: {enabled: false}, "
      "leo: {told: broadcast}}\n");
  const auto sim = test::run_program(
      "leonav-sim", quoted(place.path()) + " -o " + quoted(place.beside("run.lcmlog")) +
                        " --export " + quoted(place.beside("files")));
  INFO(sim.err);
  REQUIRE(sim.exit_code == 0);
  // No other file has an orbit of them.
  CHECK_FALSE(std::filesystem::exists(place.beside("files/run.nav")));
  CHECK_FALSE(std::filesystem::exists(place.beside("files/leo.sp3")));
  const auto import =
      test::run_program("leonav-import", quoted(place.beside("files/dataset.yaml")) + " -o " +
                                             quoted(place.beside("imported.lcmlog")));
  INFO(import.err);
  REQUIRE(import.exit_code == 0);
  const std::string alone =
      "--set 'gnss.systems=[leo]' --set ekf.motion=constant_velocity --set "
      "'vehicle.lever_arm_b_m=[0, 0, 0]' ";
  const SolutionCsv log = replayed(place, "run.lcmlog", alone),
                    files = replayed(place, "imported.lcmlog", alone);
  // With ten low satellites in view, few of them high, it is not at every epoch.
  REQUIRE(files.rows.size() > 60);
  REQUIRE(log.rows.size() == files.rows.size());
  const TruthCsv truth = read_truth_csv(place.beside("files/truth.csv"));
  std::size_t compared = 0;
  for (std::size_t i = 0; i < files.rows.size(); ++i) {
    const SolutionRow& row = files.rows[i];
    REQUIRE(row.pva.time == log.rows[i].pva.time);
    const Eigen::Vector3d p_e = to_ecef(row.pva.position);
    INFO("epoch " << i);
    CHECK((p_e - to_ecef(log.rows[i].pva.position)).norm() < 0.02);
    for (const TruthPoint& point : truth.points) {
      if (point.time != row.pva.time) continue;
      ++compared;
      CHECK((p_e - to_ecef(point.position)).norm() < 3.0 * row.sigma_p_n->norm());
    }
  }
  CHECK(compared == files.rows.size());
}

TEST_CASE("RTKLIB reads the files, and positions by each system of GPS, Galileo and BeiDou") {
  if (!test::have_programs("leonav-sim") || !test::have_rtklib()) return;
  // Without an ionosphere one frequency does, and the messages' group delays must be right.
  const std::string quiet = "{told: broadcast, broadcast: {orbit_error_m: 0, clock_error_m: 0}}";
  const test::TemporaryFile place(
      "scenario.yaml",
      "duration_s: 60\nimu: {enabled: false}\natmosphere: {tecu: 0}\nreceiver: {lever_arm_b_m: "
      "[0, 0, 0], noise: {gps: {code_m: 0}, galileo: {code_m: 0}, beidou: {code_m: 0}}}\n"
      "satellites: {gps: " +
          quiet + ", galileo: " + quiet + ", beidou: " + quiet + ", leo: {enabled: false}}\n");
  const auto sim = test::run_program(
      "leonav-sim", quoted(place.path()) + " -o " + quoted(place.beside("run.lcmlog")) +
                        " --export " + quoted(place.beside("files")));
  INFO(sim.err);
  REQUIRE(sim.exit_code == 0);
  const TruthCsv truth = read_truth_csv(place.beside("files/truth.csv"));
  for (const char* const system : {"1", "8", "32"}) {
    std::ofstream(place.beside("rtklib.conf"))
        << "pos1-posmode=single\npos1-frequency=l1\npos1-elmask=15\npos1-ionoopt=off\n"
           "pos1-tropopt=saas\npos1-navsys="
        << system << "\nout-solformat=xyz\nout-timesys=gpst\nout-timeform=tow\n";
    const std::string command = "cd " + quoted(place.beside("files")) +
                                " && rnx2rtkp -k ../rtklib.conf -o rtklib.pos run.obs run.nav "
                                ">/dev/null 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
    std::ifstream file(place.beside("files/rtklib.pos"));
    int epochs = 0;
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line[0] == '%') continue;
      std::istringstream fields(line);
      int week = 0;
      double tow = 0.0;
      Eigen::Vector3d p_e;
      fields >> week >> tow >> p_e.x() >> p_e.y() >> p_e.z();
      const GpsTime time = GpsTime::from_week_and_tow(week, tow);
      for (const TruthPoint& point : truth.points) {
        if (std::abs(seconds_between(point.time, time)) > 1e-3) continue;
        ++epochs;
        INFO("system " << system << " at " << tow);
        CHECK((to_ecef(point.position) - p_e).norm() < 2.5);  // its troposphere is another
      }
    }
    CHECK(epochs > 40);
  }
}

TEST_CASE("Files of orbits state whether they hold what the receiver gets") {
  if (!test::have_programs("leonav-sim")) return;
  const test::TemporaryFile place("scenario.yaml", "name: short\nduration_s: 20\n");
  for (const bool renamed : {false, true}) {
    const std::string folder = place.beside(renamed ? "renamed" : "files");
    const auto sim = test::run_program(
        "leonav-sim", quoted(place.path()) + " -o " + quoted(place.beside("run.lcmlog")) +
                          (renamed ? " --leo-as-gps" : "") + " --export " + quoted(folder));
    INFO(sim.err);
    REQUIRE(sim.exit_code == 0);
    CHECK(sim.out.find("20 s simulated in ") != std::string::npos);
    const std::string orbits = test::text_of(folder + "/gps.sp3");
    CHECK((orbits.find("without any error") != std::string::npos) == renamed);
    CHECK((orbits.find("errors included") == std::string::npos) == renamed);
  }
}
