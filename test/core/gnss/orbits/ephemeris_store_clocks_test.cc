// Clocks of clock files beside orbits, and what a state says of where it comes from.
#include <limits>
#include <random>
#include <set>

#include "broadcast_oracle.h"
#include "core/base/capacity.h"
#include "core/gnss/measurement/transmission_state.h"
#include "core/gnss/orbits/ephemeris_store.h"
#include "gps_5_at_noon.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::kG05;
using test::kNoon;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Ephemeris gps(double toe_s, std::uint16_t issue) {
  Ephemeris e;
  e.satellite = kG05;
  e.toe = e.toc = kNoon.plus_seconds(toe_s);
  e.issue = issue;
  e.sqrt_a = 5153.7;
  e.i0 = 0.96;
  e.accuracy_m = 2.0;
  return e;
}

PreciseState orbit_at(double t, double clock_s) {
  PreciseState state;
  state.satellite = kG05;
  state.time = kNoon.plus_seconds(t);
  state.p_e = broadcast_state(gps(0, 1), state.time).p_e;
  state.clock_s = clock_s;
  return state;
}

PreciseState clock_at(double t, double clock_s) {
  PreciseState state = orbit_at(t, clock_s);
  state.p_e.setConstant(kNan);
  return state;
}

// Orbits every 15 minutes with a clock of 1e-5 s, clocks of 2e-5 s every 30 s over [0, 600] s.
EphemerisStore filled() {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  for (int i = -8; i <= 8; ++i) REQUIRE(ephemeris_store.add(orbit_at(900.0 * i, 1e-5)));
  for (int i = 0; i <= 20; ++i) REQUIRE(ephemeris_store.add(clock_at(30.0 * i, 2e-5)));
  return ephemeris_store;
}

SatelliteState state_at(const EphemerisStore& ephemeris_store, double t) {
  SatelliteState state;
  REQUIRE(ephemeris_store.state_at(kG05, kNoon.plus_seconds(t), &state) == LookupStatus::kOk);
  return state;
}

}  // namespace

TEST_CASE("clocks of a clock file serve where they are, the orbits' clocks elsewhere",
          "[satellite_catalog]") {
  const EphemerisStore ephemeris_store = filled();
  const SatelliteState fine = state_at(ephemeris_store, 450.0),
                       coarse = state_at(ephemeris_store, 1350.0);
  CHECK(fine.source == OrbitSource::kPrecise);
  CHECK(coarse.source == OrbitSource::kPrecise);
  CHECK(std::abs(fine.clock_s - 2e-5) < 5e-8);  // the rest is the relativistic term
  CHECK(std::abs(coarse.clock_s - 1e-5) < 5e-8);
  // 15 minutes against 30 s, both in the middle: sqrt(30) times the clock's error.
  const SatelliteState middle = state_at(ephemeris_store, 465.0);
  CHECK(coarse.sigma_change_m == Approx(3.6e-3 * 15.0).margin(2e-3));
  CHECK(middle.sigma_change_m == Approx(3.6e-3 * std::sqrt(7.5)).margin(1e-3));
  CHECK(coarse.sigma_m > middle.sigma_m);
  CHECK(middle.sigma_m > middle.sigma_change_m);
  CHECK((fine.p_e - broadcast_state(gps(0, 1), kNoon.plus_seconds(450.0)).p_e).norm() < 1e-3);
  // Clocks alone place no satellite.
  EphemerisStore clocks_only{EphemerisConfig{}};
  for (int i = 0; i <= 20; ++i) REQUIRE(clocks_only.add(clock_at(30.0 * i, 2e-5)));
  SatelliteState state;
  CHECK(clocks_only.state_at(kG05, kNoon.plus_seconds(100.0), &state) != LookupStatus::kOk);
}

TEST_CASE("the issue changes when other elements serve, and only then", "[satellite_catalog]") {
  EphemerisStore ephemeris_store = filled();
  const std::uint32_t fine = state_at(ephemeris_store, 450.0).issue,
                      coarse = state_at(ephemeris_store, 1350.0).issue;
  CHECK(fine != 0);
  CHECK(coarse != 0);
  CHECK(fine != coarse);
  CHECK(state_at(ephemeris_store, 10.0).issue == fine);
  CHECK(state_at(ephemeris_store, 5000.0).issue == coarse);
  std::set<std::uint32_t> seen = {0, fine, coarse};
  for (int i = 0; i < 4; ++i) {
    const double toe_s = 86'400.0 + 7200.0 * i;
    REQUIRE(ephemeris_store.add(gps(toe_s, static_cast<std::uint16_t>(7 + i))));
    const SatelliteState state = state_at(ephemeris_store, toe_s + 100.0);
    CHECK(state.source == OrbitSource::kBroadcast);
    CHECK(state.sigma_change_m == 0.0);
    CHECK(seen.insert(state.issue).second);
    CHECK(state_at(ephemeris_store, toe_s - 100.0).issue == state.issue);
  }
  Ephemeris same_number = gps(86'400.0 + 4 * 7200.0, 10);
  REQUIRE(ephemeris_store.add(same_number));
  CHECK(seen.insert(state_at(ephemeris_store, 86'400.0 + 4 * 7200.0).issue).second);

  SatelliteInView in_view;
  in_view.satellite = kG05;
  const Ephemeris* broadcast = nullptr;
  REQUIRE(satellite_at_transmission(ephemeris_store, kNoon.plus_seconds(450.0), 2.2e7,
                                    Eigen::Vector3d::Zero(), &in_view,
                                    &broadcast) == LookupStatus::kOk);
  CHECK(in_view.orbit_issue == fine);
  CHECK(in_view.orbit_sigma_change_m > 0.0);
  CHECK(in_view.orbit_sigma_change_m < in_view.orbit_sigma_m);
}

TEST_CASE("changes of clock and orbit are not interpolated across", "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  REQUIRE(ephemeris_store.add(gps(0, 1)));
  const auto add = [&](bool clock_event, bool maneuver) {
    for (int i = -8; i <= 8; ++i) {
      PreciseState state = orbit_at(900.0 * i, i < 1 ? 1e-5 : 3e-5);
      if (i >= 1 && maneuver) state.p_e.x() += 50.0;
      state.clock_event = clock_event && i == 1;
      state.maneuver = maneuver && i == 1;
      REQUIRE(ephemeris_store.add(state));
    }
  };
  SECTION("the clock") {
    add(true, false);
    CHECK(state_at(ephemeris_store, 450.0).source == OrbitSource::kBroadcast);
    CHECK(state_at(ephemeris_store, -1.0).source == OrbitSource::kPrecise);
    CHECK(state_at(ephemeris_store, 901.0).source == OrbitSource::kPrecise);
    CHECK(std::abs(state_at(ephemeris_store, 901.0).clock_s - 3e-5) < 5e-8);
    // Finer clocks tell where in the interval it happened.
    for (int i = 0; i <= 30; ++i)
      REQUIRE(ephemeris_store.add(clock_at(30.0 * i, i < 15 ? 1e-5 : 3e-5)));
    CHECK(state_at(ephemeris_store, 400.0).source == OrbitSource::kPrecise);
    CHECK(std::abs(state_at(ephemeris_store, 400.0).clock_s - 1e-5) < 5e-8);
    CHECK(state_at(ephemeris_store, 435.0).source == OrbitSource::kBroadcast);
    CHECK(std::abs(state_at(ephemeris_store, 470.0).clock_s - 3e-5) < 5e-8);
  }
  SECTION("the orbit") {
    add(false, true);
    CHECK(state_at(ephemeris_store, 450.0).source == OrbitSource::kBroadcast);
    const SatelliteState before = state_at(ephemeris_store, -450.0),
                         after = state_at(ephemeris_store, 1350.0);
    CHECK(before.source == OrbitSource::kPrecise);
    CHECK(after.source == OrbitSource::kPrecise);
    const auto truth = [](double t) {
      return broadcast_state(gps(0, 1), kNoon.plus_seconds(t)).p_e;
    };
    // One-sided polynomials: as good as they say.
    CHECK((before.p_e - truth(-450.0)).norm() < 3.0 * before.sigma_m);
    CHECK((after.p_e - truth(1350.0) - Eigen::Vector3d(50.0, 0.0, 0.0)).norm() <
          3.0 * after.sigma_m);
  }
  SECTION("predictions are less sure") {
    add(false, false);
    const double sigma_m = state_at(ephemeris_store, -450.0).sigma_m;
    for (int i = -8; i <= 8; ++i) {
      PreciseState state = orbit_at(900.0 * i, 1e-5);
      state.clock_predicted = state.orbit_predicted = true;
      REQUIRE(ephemeris_store.add(state));
    }
    CHECK(state_at(ephemeris_store, -450.0).sigma_m > sigma_m + 0.3);
  }
}

TEST_CASE("clocks come in any order, repeat, and go on for ever", "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  for (int i = -8; i <= 8; ++i) REQUIRE(ephemeris_store.add(orbit_at(900.0 * i, kNan)));
  std::mt19937 generator(7);
  std::vector<int> order;
  for (int i = 0; i < 40; ++i) order.push_back(i);
  std::shuffle(order.begin(), order.end(), generator);
  for (const int i : order) REQUIRE(ephemeris_store.add(clock_at(30.0 * i, 1e-6)));
  for (const int i : order)
    REQUIRE(ephemeris_store.add(clock_at(30.0 * i, 2e-5 + 1e-11 * 30.0 * i)));
  for (double t = 0.0; t < 1170.0; t += 7.0) {
    CHECK(std::abs(state_at(ephemeris_store, t).clock_s - (2e-5 + 1e-11 * t)) < 5e-8);
  }
  for (int i = 40; i < 230; ++i) {
    REQUIRE(ephemeris_store.add(clock_at(30.0 * i, 2e-5 + 1e-11 * 30.0 * i)));
    CHECK(state_at(ephemeris_store, 30.0 * (i - 3) + 11.0).source == OrbitSource::kPrecise);
  }
  // No clock at all there: no precise state, as there is no broadcast one either.
  SatelliteState state;
  CHECK(ephemeris_store.state_at(kG05, kNoon.plus_seconds(-100.0), &state) ==
        LookupStatus::kTooOld);
}

TEST_CASE("bad clocks change nothing", "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  CHECK_FALSE(ephemeris_store.add(clock_at(0.0, kNan)));
  CHECK_FALSE(ephemeris_store.add(clock_at(0.0, 0.999)));
  CHECK_FALSE(ephemeris_store.add(clock_at(0.0, std::numeric_limits<double>::infinity())));
  PreciseState half = clock_at(0.0, 1e-5);
  half.p_e.x() = 2.6e7;
  CHECK_FALSE(ephemeris_store.add(half));
}

}  // namespace leonav
