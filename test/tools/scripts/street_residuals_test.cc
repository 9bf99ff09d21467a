// tools/scripts/lib/street_residuals.py tells the errors of a replay at the true positions: of a
// simulated run, where they are known.
#include <cmath>
#include <iostream>
#include <map>
#include <vector>

#include "drivers/csv/csv_rows.h"
#include "support/catch.h"
#include "support/programs/program_run.h"
#include "support/temporary_file.h"

using namespace leonav;
using namespace leonav::test;

namespace {

struct Row {
  double time_s, code_m, doppler_m_s;
  int carrier;
};

std::map<std::string, std::vector<Row>> read_library(const std::string& path) {
  std::map<std::string, std::vector<Row>> found;
  CsvRows rows(path, "satellite,time_s,code_1_m,doppler_m_s,carrier", "a library");
  while (rows.next()) {
    const auto code = rows.number(rows.column("code_1_m"));
    if (!code) continue;
    found[std::string(rows.text(rows.column("satellite")))].push_back(
        {*rows.number(rows.column("time_s")), *code,
         rows.number(rows.column("doppler_m_s")).value_or(0.0),
         static_cast<int>(*rows.number(rows.column("carrier")))});
  }
  return found;
}

}  // namespace

TEST_CASE("Errors of a recording are told at its true positions", "[tools]") {
  if (!have_programs("leonav-sim", "leonav-replay")) return;
  if (std::system("command -v python3 >/dev/null") != 0) {
    std::cout << "SKIPPED: no python3\n";
    return;
  }
  // Two satellites' ranges are wrong for a while, by a jump and by a drift; the estimator believes
  // some of it, so that its own residuals are smaller.
  const TemporaryFile scenario(
      "s.yaml",
      "duration_s: 400\nroute: {standing_s: 20}\nimu: {enabled: false}\n"
      "receiver: {lever_arm_b_m: [0, 0, 0], multipath: {code_m: 0, carrier_m: 0}}\n"
      "satellites: {beidou: {enabled: false}, leo: {enabled: false}}\n"
      "faults: [{kind: satellite_clock, from_s: 200, to_s: 260, satellites: [G05], jump_m: 30},\n"
      "         {kind: satellite_clock, from_s: 300, to_s: 330, satellites: [E09], drift_m_s: "
      "2}]\n");
  const std::string log = scenario.beside("run.lcmlog"), out = scenario.beside("out");
  REQUIRE(run_program("leonav-sim", scenario.path() + " -o " + log).exit_code == 0);
  REQUIRE(run_program("leonav-replay",
                      "--preset realtime --set ekf.motion=constant_velocity --set "
                      "gnss.code_combination=single_frequency --set robust.enabled=false --out " +
                          out + " " + log)
              .exit_code == 0);
  const std::string library = scenario.beside("library.csv");
  const std::string command = "python3 -B '" LEONAV_SOURCE_DIR
                              "/tools/scripts/lib/street_residuals.py' run '" +
                              out + "' '" + scenario.beside("truth.csv") + "' '" + library + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  const auto found = read_library(library);
  CHECK(found.size() > 10);
  int jumped = 0, drifted = 0, plain = 0;
  double square = 0.0, farthest_m = 0.0;
  for (const auto& [satellite, rows] : found) {
    for (const Row& row : rows) {
      if (satellite == "G05") {
        jumped += std::abs(row.code_m - 30.0) < 4.0 ? 1 : 0;
      } else if (satellite == "E09") {
        drifted += std::abs(row.doppler_m_s - 2.0) < 0.5 ? 1 : 0;
        farthest_m = std::max(farthest_m, row.code_m);
      } else {
        square += row.code_m * row.code_m;
        ++plain;
      }
    }
  }
  CHECK((jumped >= 58 && jumped <= 62));
  CHECK((drifted >= 27 && drifted <= 32));
  CHECK(farthest_m == Approx(60.0).margin(5.0));
  // The noise that the scenario has, at the C/N0 of its satellites, and a part of the median's.
  CHECK(std::sqrt(square / plain) < 1.0);
}
