// Pulses against the way of the drive itself.
#include "tools/sim/run/pulse_counter.h"

#include <algorithm>
#include <cmath>

#include "support/catch.h"
#include "tools/sim/places/odometer.h"
#include "tools/sim/route/drive.h"
#include "tools/sim/scenario/scenario_yaml.h"

using namespace leonav;

namespace {

sim::Scenario scenario() {
  return sim::load_scenario_text("duration_s: 120\nroute: {standing_s: 10}\n", "test.yaml");
}

std::vector<OdometerIncrement> all(const sim::OdometerConfig& config, const SplineMotion& motion) {
  sim::PulseCounter counter(config, motion);
  std::vector<OdometerIncrement> increments;
  OdometerIncrement next;
  for (double t = 0.0; t < 110.0; t += 0.25)
    while (counter.next(t, &next)) increments.push_back(next);
  return increments;
}

}  // namespace

TEST_CASE("pulses add up to the way, times the scale, to a pulse; intervals join") {
  const auto drive = sim::drive(scenario());
  sim::OdometerConfig config;
  config.rate_hz = 7.0;
  config.scale_error = 0.02;
  config.resolution_m = 0.11;
  const auto increments = all(config, drive);
  REQUIRE(increments.size() == 768);  // by 109.75 s
  const sim::Odometer way(drive);
  double sum_m = 0.0;
  GpsTime end = drive.start();
  for (const OdometerIncrement& one : increments) {
    REQUIRE(one.start() == end);
    end = one.time;
    sum_m += one.distance_m;
    const double pulses = one.distance_m / config.resolution_m;
    CHECK(std::abs(pulses - std::round(pulses)) < 1e-6);
    const double t = seconds_between(end, drive.start());
    if (t < 9.0) CHECK(one.distance_m == 0.0);
    CHECK(std::abs(sum_m - 1.02 * way.travelled_m(t)) < 0.11 + 0.002 * sum_m);
  }
  CHECK(sum_m > 100.0);
}

TEST_CASE("slip turns the wheel faster while the vehicle speeds up; a locked one stands") {
  const auto drive = sim::drive(scenario());
  const auto sum = [&](const sim::OdometerConfig& config) {
    double sum_m = 0.0;
    for (const OdometerIncrement& one : all(config, drive)) sum_m += one.distance_m;
    return sum_m;
  };
  sim::OdometerConfig plain, slipping, locking;
  plain.rate_hz = slipping.rate_hz = locking.rate_hz = 10.0;
  slipping.slip_per_acceleration = 0.05;
  locking.lock_braking_m_s2 = 1.0;
  // What slip adds, slip * a * v dt, is slip * v^2 / 2: more while the vehicle speeds up, less
  // while it brakes.
  const auto slipped = all(slipping, drive), rolled = all(plain, drive);
  double added_m = 0.0, most_m = 0.0;
  for (std::size_t i = 0; i < rolled.size(); ++i) {
    added_m += slipped.at(i).distance_m - rolled[i].distance_m;
    const double t = seconds_between(rolled[i].time, drive.start());
    const double speed = drive.at(t).v_e.norm();
    CHECK(std::abs(added_m - 0.025 * speed * speed) < 2.0 * plain.resolution_m);
    most_m = std::max(most_m, added_m);
  }
  CHECK(most_m > 10.0 * plain.resolution_m);
  CHECK(sum(locking) < sum(plain));
}
