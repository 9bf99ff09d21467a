// LEO satellites whose orbits come as broadcast elements alone: a car under an open sky with two
// GPS satellites finds its way by them, and only by those that are young enough.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "scenario/recorded_runs.h"

namespace leonav::test {
namespace {

// What became of the LEO satellites of satellites.csv.
struct LeoRows {
  long used = 0, too_old = 0, by_other_orbits = 0;
  double largest_age_s = 0.0;
};

LeoRows leo_rows(const TemporaryFile& place) {
  LeoRows rows;
  std::istringstream file(text_of(place.beside("result/satellites.csv")));
  for (std::string line; std::getline(file, line);) {
    std::istringstream text(line);
    std::vector<std::string> fields;
    for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
    if (fields.size() < 10 || !fields[2].starts_with("L")) continue;
    rows.too_old += fields[3] == "ephemeris_too_old";
    if (fields[4] != "1") continue;
    ++rows.used;
    rows.by_other_orbits += fields[9] != "broadcast";
    rows.largest_age_s = std::max(rows.largest_age_s, std::strtod(fields[8].c_str(), nullptr));
  }
  return rows;
}

}  // namespace

TEST_CASE("two GPS satellites are enough with LEO's broadcast elements, and not without") {
  if (!programs() || !have_programs("leonav-sim")) return;
  const TemporaryFile place("unused", "");
  const std::string log = place.beside("run.lcmlog");
  // The elements of an arc of two minutes come a minute ahead of its middle.
  const ProgramRun sim = run_program(
      "leonav-sim",
      "'" LEONAV_SOURCE_DIR "/config/scenario/open_sky.yaml' -o '" + log +
          "' --set duration_s=150 --set places=none --set satellites.galileo.enabled=false"
          " --set satellites.beidou.enabled=false --set satellites.gps.told=broadcast"
          " --set satellites.leo.told=broadcast --set satellites.leo.only_risen=true"
          " --set satellites.leo.broadcast.issue_interval_s=120");
  CAPTURE(sim.err);
  REQUIRE(sim.exit_code == 0);
  const auto errors = [&](const std::string& systems, const std::string& more = "") {
    return errors_of(place, log,
                     config("urban") + " --set gnss.gps.max_satellites=2 --set 'gnss.systems=[" +
                         systems + "]'" + more,
                     "--truth '" + place.beside("truth.csv") + "'");
  };

  const Errors with = errors("gps, leo");
  const LeoRows rows = leo_rows(place);
  std::printf("two GPS satellites, LEO by elements: horizontal RMSE %.2f m, %ld measurements\n",
              with.rmse, rows.used);
  CHECK(with.answered == 148);
  CHECK(with.rmse < 1.5);
  CHECK(with.within > 0.98);
  CHECK(rows.used > 300);
  CHECK(rows.by_other_orbits == 0);
  CHECK(rows.too_old == 0);
  CHECK(rows.largest_age_s <= 60.0);

  const Errors without = errors("gps");
  std::printf("two GPS satellites: horizontal RMSE %.2f m\n", without.rmse);
  CHECK(without.rmse > 20.0 * with.rmse);

  const Errors young = errors("gps, leo", " --set gnss.ephemerides.max_age_leo_s=10");
  const LeoRows young_rows = leo_rows(place);
  std::printf("two GPS satellites, LEO by elements of 10 s: horizontal RMSE %.2f m\n", young.rmse);
  CHECK(young_rows.too_old > 300);
  CHECK(young_rows.used > 30);
  CHECK(young_rows.largest_age_s <= 10.0);
  CHECK(young.within > 0.9);
  CHECK(young.rmse > 3.0 * with.rmse);
}

}  // namespace leonav::test
