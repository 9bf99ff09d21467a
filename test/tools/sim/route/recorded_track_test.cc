// A truth file as the route.
#include "tools/sim/route/recorded_track.h"

#include <cmath>

#include "core/earth/rotation.h"
#include "support/catch.h"
#include "support/temporary_file.h"
#include "tools/sim/route/drive.h"
#include "tools/sim/scenario/scenario_yaml.h"

using namespace leonav;
using namespace leonav::sim;
using leonav::test::TemporaryFile;

namespace {

// A drive as the simulator would have it, to be written and read again.
SplineMotion original() {
  Scenario scenario = load_scenario_text("duration_s: 200\nroute: {standing_s: 5}", "test.yaml");
  scenario.seed = 3;
  return drive(scenario);
}

std::vector<TruthPoint> points_of(const SplineMotion& motion, bool with_attitude) {
  std::vector<TruthPoint> points;
  for (int i = 0; i <= 1900; ++i) {
    points.push_back(motion.point(motion.start().plus_seconds(0.1 * i)));
    if (!with_attitude) points.back().roll = points.back().pitch = points.back().yaw = {};
  }
  return points;
}

Scenario scenario_of_track(const std::string& file, const std::string& more = "") {
  return load_scenario_text("duration_s: 180\n" + more + "route: {file: \"" + file + "\"}",
                            "test.yaml");
}

}  // namespace

TEST_CASE("A truth file gives the route, its start and its origin", "[sim]") {
  const SplineMotion given = original();
  const TemporaryFile place("truth.csv", "");
  for (const bool with_attitude : {true, false}) {
    write_truth_csv(place.path(), points_of(given, with_attitude));
    const Scenario scenario = scenario_of_track(place.path());
    CHECK(scenario.start == given.start());
    const SplineMotion motion = drive(scenario);
    CHECK(motion.duration_s() == Approx(180.0));
    double distance = 0.0, tilt = 0.0, roll = 0.0;
    for (double t = 1.0; t < 179.0; t += 0.05) {
      const TruthPoint a = given.point(given.start().plus_seconds(t));
      const TruthPoint b = motion.point(motion.start().plus_seconds(t));
      distance = std::max(distance, (to_ecef(a.position) - to_ecef(b.position)).norm());
      tilt = std::max({tilt, std::abs(*a.roll - *b.roll), std::abs(*a.pitch - *b.pitch)});
      roll = std::max(roll, std::abs(*b.roll));
    }
    CAPTURE(with_attitude);
    CHECK(distance < 0.05);
    CHECK(roll > 0.01);
    CHECK(tilt < 0.006);
  }
  CHECK(scenario_of_track(place.path(), "start_gps_week: 2200\n").start ==
        GpsTime::from_week_and_tow(2200, 345'600.0));
}

TEST_CASE("A truth file that is no route is refused with its name", "[sim]") {
  const auto refused = [](const std::string& file) -> std::string {
    try {
      drive(scenario_of_track(file));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const std::string absent = refused("/nowhere/absent.csv");
  CHECK(absent.find("test.yaml:2: route.file") != std::string::npos);
  CHECK(absent.find("absent.csv") != std::string::npos);
  const TemporaryFile text("truth.csv", "no,columns\n1,2\n");
  CHECK(refused(text.path()).find("truth.csv") != std::string::npos);
  std::vector<TruthPoint> points = points_of(original(), false);
  points.erase(points.begin() + 500, points.begin() + 600);
  write_truth_csv(text.path(), points);
  CHECK(refused(text.path()).find("hole of 10.1") != std::string::npos);
  points.resize(10);
  write_truth_csv(text.path(), points);
  CHECK(refused(text.path()).find("at least 20") != std::string::npos);
  CHECK(refused(text.path()).find("truth.csv: the truth has 10") != std::string::npos);
  CHECK_THROWS_WITH(load_scenario_text("route: {file: x.csv, waypoints: [{}, {north_m: 50}]}", "y"),
                    Catch::Contains("exclude each other"));
}

TEST_CASE("A truth file lies beside the scenario, as files of satellites do", "[sim]") {
  const TemporaryFile scenario("scenario.yaml", "duration_s: 20\nroute: {file: drive.csv}\n");
  write_truth_csv(scenario.beside("drive.csv"), points_of(original(), false));
  CHECK(load_scenario(scenario.path()).route.file == scenario.beside("drive.csv"));
}

TEST_CASE("A truth file that leaps is refused; rows that are not read are reported", "[sim]") {
  const TemporaryFile file("truth.csv", "");
  std::vector<TruthPoint> points = points_of(original(), false);
  std::vector<TruthPoint> leaping = points;
  for (std::size_t i = 900; i < leaping.size(); ++i) leaping[i].position.latitude *= -1.0;
  write_truth_csv(file.path(), leaping);
  CHECK_THROWS_WITH(scenario_of_track(file.path()), Catch::Contains("test.yaml:2: route.file: ") &&
                                                        Catch::Contains("truth.csv") &&
                                                        Catch::Contains("500 m/s"));
  // The fastest that goes: an airliner's 300 m/s.
  std::vector<TruthPoint> fast = points;
  for (std::size_t i = 0; i < fast.size(); ++i) {
    fast[i].position.latitude += 30.0 * static_cast<double>(i) / 6.37e6;
  }
  write_truth_csv(file.path(), fast);
  CHECK(left_out(scenario_of_track(file.path()).route.file_report).empty());
  std::swap(points[300], points[700]);
  write_truth_csv(file.path(), points);
  const std::string told = left_out(scenario_of_track(file.path()).route.file_report);
  INFO(told);
  CHECK(told.find("2 rows were left out: ") == 0);
  CHECK(told.find("truth.csv:302: ") != std::string::npos);
  points.resize(22);
  points[5].time = points[6].time = points[7].time = points[20].time;
  write_truth_csv(file.path(), points);
  CHECK_THROWS_WITH(drive(scenario_of_track(file.path())),
                    Catch::Contains("at least 20") && Catch::Contains("rows were left out"));
}
