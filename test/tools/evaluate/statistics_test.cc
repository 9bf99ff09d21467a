#include "tools/evaluate/statistics.h"

#include <cmath>

#include "core/earth/rotation.h"
#include "support/catch.h"
#include "support/temporary_file.h"
#include "tools/common/arguments.h"

using namespace leonav;

namespace {

constexpr double kLatitude = 0.7, kLongitude = -1.8, kHeight = 120.0;

// A point `neu` metres off the origin, at second `t`.
TrackPoint point(double t, const Eigen::Vector3d& neu) {
  const Geodetic origin{kLatitude, kLongitude, kHeight};
  const Eigen::Matrix3d C_en = rotation_ecef_to_ned(origin).transpose();
  TrackPoint p;
  p.time = GpsTime::from_week_and_tow(2200, 1000.0 + t);
  p.position = to_geodetic(to_ecef(origin) + C_en * Eigen::Vector3d(neu.x(), neu.y(), -neu.z()));
  return p;
}

Track straight(int n, double step_s, const Eigen::Vector3d& velocity_neu,
               const Eigen::Vector3d& offset) {
  Track track;
  for (int i = 0; i < n; ++i)
    track.push_back(point(i * step_s, offset + i * step_s * velocity_neu));
  return track;
}

}  // namespace

TEST_CASE("a constant offset comes out component by component") {
  const Eigen::Vector3d velocity(3.0, -4.0, 0.0), offset(1.0, -2.0, 3.0);
  const Track truth = straight(101, 0.1, velocity, Eigen::Vector3d::Zero());
  const Track solution = straight(10, 1.0, velocity, offset);
  const Evaluation e = evaluate("x", solution, truth, {}, 3.0);
  CHECK(e.north.mean == Approx(1.0).margin(1e-4));
  CHECK(e.east.mean == Approx(-2.0).margin(1e-4));
  CHECK(e.up.mean == Approx(3.0).margin(1e-4));
  CHECK(e.horizontal.rmse == Approx(std::sqrt(5.0)).margin(1e-4));
  CHECK(e.three_d.p95 == Approx(std::sqrt(14.0)).margin(1e-4));
  CHECK_FALSE(e.convergence_s);

  ErrorOptions options;
  options.remove_offset = true;
  CHECK(evaluate("x", solution, truth, options, 3.0).three_d.rmse < 1e-4);
}

TEST_CASE("the truth is not interpolated over a hole, and what is missing lowers availability") {
  Track truth = straight(201, 0.1, {1, 0, 0}, Eigen::Vector3d::Zero());
  truth.erase(truth.begin() + 50, truth.begin() + 100);  // 5 s without truth
  Track solution = straight(21, 1.0, {1, 0, 0}, Eigen::Vector3d::Zero());
  solution.erase(solution.begin() + 15);
  const Evaluation e = evaluate("x", solution, truth, {}, 3.0);
  CHECK(e.comparison.expected_epochs == 21);
  CHECK(e.comparison.solution_epochs == 20);
  CHECK(e.comparison.without_truth == 5);
  CHECK(e.availability == Approx(20.0 / 21.0));
}

TEST_CASE("stamps a millisecond off the truth's ends answer all the same") {
  const Track truth = straight(101, 0.25, {1, 0, 0}, Eigen::Vector3d::Zero());
  for (const double shift_s : {-0.001, 0.001, -0.12, 0.12}) {
    CAPTURE(shift_s);
    Track solution = truth;
    for (TrackPoint& p : solution) p.time = p.time.plus_seconds(shift_s);
    Evaluation e = evaluate("x", solution, truth, {}, 3.0);
    CHECK(e.comparison.solution_epochs == 101);
    CHECK(e.comparison.expected_in_truth == 101);
    CHECK(e.comparison.expected_epochs == 101);
    CHECK(e.comparison.errors.size() == 100);
    CHECK(e.availability == 1.0);
    solution.erase(solution.begin() + 50);
    e = evaluate("x", solution, truth, {}, 3.0);
    CHECK(e.availability == Approx(100.0 / 101.0));
    ErrorOptions options;  // a span the user asks for is exact
    options.from = truth[10].time;
    options.to = truth[20].time;
    CHECK(evaluate("x", solution, truth, options, 3.0).comparison.solution_epochs == 10);
  }
}

TEST_CASE("percentiles are of absolute values and count the sample that reaches the share") {
  std::vector<double> values;
  for (int i = 1; i <= 100; ++i) values.push_back(i % 2 == 0 ? i : -i);
  CHECK(percentile(values, 0.50) == 50.0);
  CHECK(percentile(values, 0.95) == 95.0);
  CHECK(percentile(values, 0.99) == 99.0);
  CHECK(percentile(values, 1.0) == 100.0);
}

TEST_CASE("convergence needs ten epochs in a row") {
  std::vector<ErrorSample> errors(40);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors[i].time = GpsTime::from_week_and_tow(2200, static_cast<double>(i));
    errors[i].neu.x() = i < 8 || i == 15 ? 5.0 : 1.0;
  }
  // Epochs 8 to 14 are only seven; the ten begin after the relapse at 15.
  CHECK(convergence_time_s(errors, 3.0) == Approx(16.0));
  CHECK_FALSE(convergence_time_s(errors, 0.5));
}

TEST_CASE("without a yaw in the truth the course over ground is the reference, when moving") {
  Track truth = straight(101, 0.1, {2.0, 2.0, 0.0}, Eigen::Vector3d::Zero());
  Track solution = straight(10, 1.0, {2.0, 2.0, 0.0}, Eigen::Vector3d::Zero());
  for (TrackPoint& p : truth) p.v_n = Eigen::Vector3d(2.0, 2.0, 0.0);
  for (TrackPoint& p : solution) p.rpy = {0.1, 0.0, M_PI / 4 + 0.05};
  const Evaluation e = evaluate("x", solution, truth, {}, 3.0);
  REQUIRE(e.yaw);
  CHECK(e.yaw_from_course);
  CHECK(e.yaw->mean == Approx(0.05).margin(1e-9));
  CHECK_FALSE(e.roll);
  ErrorOptions options;
  options.course_speed_m_s = 3.0;
  CHECK_FALSE(evaluate("x", solution, truth, options, 3.0).yaw);
}

TEST_CASE("tracks without common time are an error, not an empty table") {
  const Track truth = straight(10, 1.0, {1, 0, 0}, Eigen::Vector3d::Zero());
  Track solution = truth;
  for (TrackPoint& p : solution) p.time = p.time.plus_seconds(1000.0);
  CHECK_THROWS(evaluate("x", solution, truth, {}, 3.0));
}

TEST_CASE("stated sigmas are checked against the errors") {
  const Track truth = straight(101, 0.1, {1, 0, 0}, Eigen::Vector3d::Zero());
  Track solution = straight(10, 1.0, {1, 0, 0}, Eigen::Vector3d(0.0, 1.0, 0.0));
  for (TrackPoint& p : solution) p.sigma_neu = Eigen::Vector3d(0.3, 0.3, 0.3);
  CHECK(*evaluate("x", solution, truth, {}, 3.0).within_three_sigma == Approx(2.0 / 3.0));
}

TEST_CASE("settled is from where on the error never again exceeds the bound") {
  const Track truth = straight(101, 1.0, {1, 0, 0}, Eigen::Vector3d::Zero());
  Track solution = straight(50, 1.0, {1, 0, 0}, {0, 0.01, 0});
  solution[20] = point(20.0, {20, 0.5, 0});
  const Evaluation e = evaluate("x", solution, truth, {}, 0.1);
  REQUIRE(e.settled_s);
  CHECK(*e.settled_s == Approx(21.0));
  CHECK(*e.convergence_s == Approx(0.0));
  solution.back() = point(49.0, {49, 0.5, 0});
  CHECK_FALSE(evaluate("x", solution, truth, {}, 0.1).settled_s);
}

TEST_CASE("a surveyed point is a truth that stands for as long as the solution lasts") {
  const TrackPoint surveyed = surveyed_point("40.107045659157525,-103.13240312354818,120.0");
  Track solution = straight(11, 1.0, Eigen::Vector3d::Zero(), {0.3, -0.4, 1.2});
  for (TrackPoint& row : solution) row.v_n = Eigen::Vector3d(0.1, 0.0, 0.0);
  ErrorOptions options;
  options.max_truth_gap_s = INFINITY;
  const Evaluation e = evaluate("x", solution, standing_at(surveyed, solution), options, 3.0);
  CHECK(e.north.mean == Approx(0.3).margin(1e-4));
  CHECK(e.east.mean == Approx(-0.4).margin(1e-4));
  CHECK(e.up.mean == Approx(1.2).margin(1e-4));
  CHECK(e.comparison.solution_epochs == 11);
  CHECK(e.comparison.without_truth == 0);
  REQUIRE(e.speed);
  CHECK(e.speed->mean == Approx(0.1).margin(1e-6));
  for (const char* wrong : {"", "40", "40,-103", "91,0,0", "40,-103,x", "40,-103,1e9"})
    CHECK_THROWS_AS(surveyed_point(wrong), UsageError);
}

TEST_CASE("why there is nothing to compare is said") {
  const Track truth = straight(3, 10.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const auto said = [&](const Track& solution) {
    try {
      evaluate("x", solution, truth, {}, 3.0);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Track within = {point(4.0, Eigen::Vector3d::Zero()), point(5.0, Eigen::Vector3d::Zero())};
  CHECK(said(within).find("raise --max-truth-gap") != std::string::npos);
  for (TrackPoint& row : within) row.time = row.time.plus_seconds(1000.0);
  CHECK(said(within).find("no common time: the solution is from 2200:2004.0 to 2200:2005.0, the "
                          "truth from 2200:1000.0 to 2200:1020.0") != std::string::npos);
}

TEST_CASE("a solution of RTKLIB is a truth, without its sigmas") {
  const auto row = [](const std::string& tow) {
    return "2200 " + tow +
           "    45.000000000    7.000000000   100.0000   1   9   0.0100   0.0200   0.0300   0.0000 "
           " "
           " 0.0000   0.0000   0.00    3.0\n";
  };
  const test::TemporaryFile file(
      "base.pos",
      "% program   : RTKLIB ver.2.4.3\n"
      "%  GPST          latitude(deg) longitude(deg)  height(m)   Q  ns   "
      "sdn(m)   sde(m)   sdu(m)  sdne(m)  sdeu(m)  sdun(m) age(s)  "
      "ratio\n" +
          row("1000.000") + row("1001.000") + row("1002.000"));
  const Track truth = load_truth(file.path());
  REQUIRE(truth.size() == 3);
  CHECK_FALSE(truth[0].sigma_neu);
  Track solution = {truth[0], truth[0]};
  for (std::size_t i = 0; i < solution.size(); ++i) {
    solution[i].time = truth[i].time.plus_seconds(0.5);
    solution[i].position.height += 1.5;
  }
  const Evaluation e = evaluate("x", solution, truth, {}, 3.0);
  CHECK(e.up.mean == Approx(1.5).margin(1e-4));
  CHECK(e.comparison.without_truth == 0);
}
