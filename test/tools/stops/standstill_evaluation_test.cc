// Declared standstills against a truth made by hand.
#include <cmath>
#include <sstream>

#include "support/catch.h"
#include "tools/stops/standstill_evaluation.h"

namespace leonav::test {
namespace {

GpsTime at(double s) { return GpsTime::from_week_and_tow(2136, 345'600.0 + s); }

// Ten times a second for `seconds`, north at `speed`, appended.
void go(Track* truth, double seconds, double speed) {
  const double from = truth->empty() ? 0.0 : seconds_between(truth->back().time, at(0.0)) + 0.1;
  for (int i = 0; i < static_cast<int>(std::lround(10.0 * seconds)); ++i) {
    TrackPoint point;
    point.time = at(from + 0.1 * i);
    point.v_n = Eigen::Vector3d(speed, 0.0, 0.0);
    truth->push_back(point);
  }
}

// Asked five times a second.
void ask(std::vector<DetectorInstant>* asked, double from, double to, bool standing) {
  for (int i = 0; from + 0.2 * i < to; ++i) asked->push_back({at(from + 0.2 * i), standing});
}

// 10 s driving, 10 s standing, 10 s at 0.1 m/s, 10 s at 0.03 m/s, 10 s standing, 10 s driving.
Track stop_and_go() {
  Track truth;
  for (const double speed : {8.0, 0.0, 0.1, 0.03, 0.0, 8.0}) go(&truth, 10.0, speed);
  return truth;
}

}  // namespace

TEST_CASE("a stop that is found after a second is found, and nothing is false") {
  std::vector<DetectorInstant> asked;
  ask(&asked, 0.0, 11.0, false);
  ask(&asked, 11.0, 19.8, true);
  ask(&asked, 20.0, 41.0, false);
  ask(&asked, 41.0, 49.8, true);
  const StopsResult result = evaluate_stops(asked, stop_and_go(), {});
  CHECK(result.wrong.empty());
  REQUIRE(result.stops.size() == 2);
  CHECK(result.stops[0].found_after_s == Approx(1.0).margin(0.01));
  CHECK(result.stops[0].found_s == Approx(8.9).margin(0.3));
  CHECK(result.stops[1].found_after_s == Approx(1.0).margin(0.01));
  CHECK(result.slow > 40);
  CHECK(result.slow_standing == 0);
  CHECK(result.without_truth == 0);
}

TEST_CASE("one false at the speed of traffic, one barely moving, one stop missed") {
  std::vector<DetectorInstant> asked;
  ask(&asked, 0.0, 25.0, false);  // the first stop is missed
  asked.push_back({at(25.0), true});
  ask(&asked, 25.2, 35.0, false);
  asked.push_back({at(35.0), true});
  ask(&asked, 35.2, 60.0, false);
  asked.push_back({at(45.0), true});
  const StopsResult result = evaluate_stops(asked, stop_and_go(), {});
  REQUIRE(result.wrong.size() == 1);
  CHECK(result.wrong[0].second == Approx(0.1).margin(1e-6));
  CHECK(result.fastest_m_s == Approx(0.1).margin(1e-6));
  CHECK(result.creeping > 40);
  CHECK(result.slow_standing == 1);
  REQUIRE(result.stops.size() == 2);
  CHECK(result.stops[0].found_after_s < 0.0);
  CHECK(result.stops[1].found_after_s == Approx(5.0).margin(0.01));
  std::ostringstream out;
  print_stops(result, {}, out);
  CAPTURE(out.str());
  CHECK(out.str().find("false               at 345625.0") != std::string::npos);
  CHECK(out.str().find("missed              at 345610.0") != std::string::npos);
  CHECK(out.str().find("1 of ") != std::string::npos);
}

TEST_CASE("instants in a gap of the truth and stops before the first question are reported") {
  Track truth;
  go(&truth, 5.0, 0.0);
  go(&truth, 5.0, 5.0);
  const Track after = stop_and_go();  // 20 s later
  for (TrackPoint point : after) {
    point.time = point.time.plus_seconds(30.0);
    truth.push_back(point);
  }
  std::vector<DetectorInstant> asked;
  ask(&asked, 15.0, 25.0, true);  // in the gap: neither right nor wrong
  ask(&asked, 31.0, 60.0, false);
  const StopsResult result = evaluate_stops(asked, truth, {});
  CHECK(result.without_truth == 50);
  CHECK(result.standing == 0);
  CHECK(result.wrong.empty());
  CHECK(result.stops_not_asked == 2);  // the one at the beginning, and that after the last question
  CHECK(result.stops.size() == 1);
}

TEST_CASE("a run without a stop states that it shows nothing of missed ones") {
  Track truth;
  go(&truth, 20.0, 5.0);
  std::vector<DetectorInstant> asked;
  ask(&asked, 0.0, 19.0, false);
  std::ostringstream out;
  print_stops(evaluate_stops(asked, truth, {}), {}, out);
  CHECK(out.str().find("true stops          none") != std::string::npos);
}

TEST_CASE("a stop across a gap of the truth is two") {
  Track truth;
  go(&truth, 5.0, 0.0);
  Track rest;
  go(&rest, 5.0, 0.0);
  for (TrackPoint point : rest) {
    point.time = point.time.plus_seconds(60.0);
    truth.push_back(point);
  }
  CHECK(stops_of(truth, {}).size() == 2);
}

}  // namespace leonav::test
