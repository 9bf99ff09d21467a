// Waypoints to motion: stops, limits, smoothness, and what is refused.
#include "tools/sim/route/drive.h"

#include <cmath>
#include <iostream>
#include <numbers>

#include "core/earth/rotation.h"
#include "support/catch.h"
#include "support/temporary_file.h"
#include "tools/sim/scenario/scenario_yaml.h"

using namespace leonav;
using namespace leonav::sim;

namespace {

constexpr double kStep = 0.02;  // s

struct Extremes {
  double speed = 0.0, climb = 0.0, along = 0.0, lateral = 0.0, jerk = 0.0;
  double roll = 0.0, pitch = 0.0, rate = 0.0;
};

Eigen::Vector3d acceleration_n(const SplineMotion& motion, double t) {
  const MotionInstant now = motion.at(t);
  return rotation_ecef_to_ned(to_geodetic(now.p_e)) * now.a_e;
}

Extremes extremes(const SplineMotion& motion) {
  Extremes most;
  const auto raise = [](double* top, double value) { *top = std::max(*top, std::abs(value)); };
  for (double t = kStep; t < motion.duration_s() - kStep; t += kStep) {
    const TruthPoint now = motion.point(motion.start().plus_seconds(t));
    const Eigen::Vector3d a = acceleration_n(motion, t);
    const double yaw = *now.yaw;
    raise(&most.speed, now.v_n->norm());
    raise(&most.climb, now.v_n->z());
    raise(&most.along, a.x() * std::cos(yaw) + a.y() * std::sin(yaw));
    raise(&most.lateral, a.y() * std::cos(yaw) - a.x() * std::sin(yaw));
    raise(&most.jerk,
          (acceleration_n(motion, t + kStep) - acceleration_n(motion, t - kStep)).norm() /
              (2.0 * kStep));
    raise(&most.roll, *now.roll);
    raise(&most.pitch, *now.pitch);
    raise(&most.rate, motion.at(t).omega_ib_b.norm());
  }
  return most;
}

Scenario scenario_of(const std::string& text) { return load_scenario_text(text, "test.yaml"); }

constexpr char kStraight[] = R"(
duration_s: 120
route:
  standing_s: 10
  waypoints:
    - {}
    - {north_m: 200.3, speed_m_s: 5, stop_s: 12}
    - {north_m: 300.3, speed_m_s: 15}
    - {north_m: 900, up_m: 10}
)";

Eigen::Vector3d ned(const Scenario& scenario, const TruthPoint& point) {
  return rotation_ecef_to_ned(scenario.route.origin) *
         (to_ecef(point.position) - to_ecef(scenario.route.origin));
}

}  // namespace

TEST_CASE("A vehicle stands where and as long as the waypoints say", "[sim]") {
  const Scenario scenario = scenario_of(kStraight);
  const SplineMotion motion = drive(scenario);
  double start = -1.0, stop_begin = -1.0, stop_end = -1.0;
  Eigen::Vector3d where;
  for (double t = 0.0; t < motion.duration_s(); t += 0.01) {
    const TruthPoint now = motion.point(motion.start().plus_seconds(t));
    const bool stands = now.v_n->norm() < 1e-3;
    if (start < 0.0 && !stands) start = t;
    if (start > 0.0 && t > start + 3.0 && stands && stop_begin < 0.0) {
      stop_begin = t;
      where = ned(scenario, now);
    }
    if (stop_begin > 0.0 && stop_end < 0.0 && !stands) stop_end = t;
  }
  std::cout << "drive: sets off after " << start << " s, stands from " << stop_begin << " to "
            << stop_end << " s at " << where.x() << " m\n";
  CHECK(start == Approx(10.0).margin(0.2));
  CHECK(stop_end - stop_begin == Approx(12.0).margin(0.3));
  CHECK(where.x() == Approx(200.3).margin(0.01));
}

TEST_CASE("Speed limits hold from waypoint to waypoint", "[sim]") {
  const Scenario scenario = scenario_of(kStraight);
  const SplineMotion motion = drive(scenario);
  double slow = 0.0, fast = 0.0;
  for (double t = 0.0; t < motion.duration_s(); t += 0.01) {
    const TruthPoint now = motion.point(motion.start().plus_seconds(t));
    const double north = ned(scenario, now).x();
    double* const top = north > 200.3 && north < 300.3 ? &slow : &fast;
    *top = std::max(*top, now.v_n->norm());
  }
  CHECK(slow < 5.01);
  CHECK(slow > 4.9);
  CHECK(fast < 15.01);
  CHECK(fast > 13.8);
}

TEST_CASE("A city drive is smooth and stays within its accelerations", "[sim]") {
  Scenario scenario = scenario_of("duration_s: 1200");
  for (scenario.seed = 1; scenario.seed <= 5; ++scenario.seed) {
    const SplineMotion motion = drive(scenario);
    const Extremes most = extremes(motion);
    std::cout << "city drive " << scenario.seed << ": " << most.speed << " m/s, along "
              << most.along << ", lateral " << most.lateral << " m/s^2, jerk " << most.jerk
              << " m/s^3, roll " << most.roll << " rad\n";
    CHECK(most.speed < 17.05);
    CHECK(most.speed > 10.0);
    CHECK(most.along < 2.1);
    CHECK(most.lateral < 2.55);
    CHECK(most.jerk < 4.0);
    CHECK(most.roll > 0.005);
    CHECK(most.roll < 0.03);
    CHECK(most.rate < 1.0);
  }
}

TEST_CASE("A UAV climbs, banks and turns", "[sim]") {
  Scenario scenario = scenario_of("duration_s: 600\nroute: {vehicle: uav}");
  for (scenario.seed = 1; scenario.seed <= 3; ++scenario.seed) {
    const SplineMotion motion = drive(scenario);
    const Extremes most = extremes(motion);
    std::cout << "flight " << scenario.seed << ": " << most.speed << " m/s, climbs with "
              << most.climb << " m/s, bank " << most.roll << " rad, pitch " << most.pitch
              << " rad, jerk " << most.jerk << " m/s^3\n";
    CHECK(most.climb > 1.0);
    CHECK(most.roll > 0.1);
    CHECK(most.roll < 0.3);
    CHECK(most.pitch > 0.1);
    CHECK(most.jerk < 8.0);
    const Eigen::Vector3d end =
        ned(scenario, motion.point(motion.start().plus_seconds(motion.duration_s() - 1.0)));
    CHECK(-end.z() > 30.0);
  }
}

TEST_CASE("A drive of a day stays near its origin", "[sim]") {
  Scenario scenario = scenario_of("duration_s: 20000\nroute: {standing_s: 0}");
  const SplineMotion motion = drive(scenario);
  double far = 0.0;
  for (double t = 0.0; t < motion.duration_s(); t += 10.0)
    far = std::max(far, ned(scenario, motion.point(motion.start().plus_seconds(t))).norm());
  CHECK(far > 500.0);
  CHECK(far < 7000.0);
}

TEST_CASE("Waypoints that make no road are refused by line and number", "[sim]") {
  const auto refused = [](const std::string& waypoints) -> std::string {
    try {
      drive(scenario_of("route:\n  waypoints: [" + waypoints + "]"));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refused("{}").find("test.yaml:2: route.waypoints: one alone") != std::string::npos);
  CHECK(refused("{}, {north_m: 0.5}") ==
        "test.yaml:2: route.waypoints[1]: is less than a metre from the waypoint before; leave one "
        "out");
  CHECK(refused("{},\n {north_m: 50},\n {north_m: 60, up_m: 20}")
            .find("test.yaml:4: route.waypoints[2]: is steeper") != std::string::npos);
  CHECK(refused("{},\n {north_m: 50},\n {north_m: 10}")
            .find("test.yaml:3: route.waypoints[1]: the road turns back") != std::string::npos);
  CHECK(refused("{}, {north_m: 50, speed_m_s: -3}").find("speed_m_s") != std::string::npos);
  CHECK(refused("{}, {north_m: .nan}").find("north_m") != std::string::npos);
  CHECK(refused("{}, {nort_m: 50}").find("nort_m") != std::string::npos);
}
