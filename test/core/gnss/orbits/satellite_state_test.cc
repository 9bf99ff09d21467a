#include "core/gnss/orbits/satellite_state.h"

#include <limits>

#include "broadcast_oracle.h"
#include "core/gnss/signals/signal.h"
#include "leo_oracle.h"
#include "support/catch.h"

namespace leonav {

TEST_CASE("Broadcast positions and clocks agree with RTKLIB's", "[satellite_state]") {
  const auto cases = test::rtklib_broadcast_cases();
  REQUIRE(cases.size() == 24);
  for (const auto& c : cases) {
    INFO(to_string(c.ephemeris.satellite) << " at toe " << c.since_toe_s << " s");
    REQUIRE(is_sane(c.ephemeris));
    const SatelliteState state =
        broadcast_state(c.ephemeris, c.ephemeris.toe.plus_seconds(c.since_toe_s));
    CHECK((state.p_e - c.p_e).norm() < 1e-3);
    CHECK(std::abs(state.clock_s - c.clock_s) < 1e-12);
    CHECK(state.age_s == Approx(std::abs(c.since_toe_s)));
    CHECK(state.source == OrbitSource::kBroadcast);
  }
}

TEST_CASE("Velocity and clock drift are the derivatives of position and clock",
          "[satellite_state]") {
  for (const auto& c : test::rtklib_broadcast_cases()) {
    INFO(to_string(c.ephemeris.satellite) << " at toe " << c.since_toe_s << " s");
    const GpsTime t = c.ephemeris.toe.plus_seconds(c.since_toe_s);
    const double h = 0.5;  // s: error of the difference quotient h^2/6 |jerk| = 2e-5 m/s...
    const auto at = [&](double dt) { return broadcast_state(c.ephemeris, t.plus_seconds(dt)); };
    // ...which the five-point rule brings down to 1e-9 m/s.
    const Eigen::Vector3d v =
        (8.0 * (at(h).p_e - at(-h).p_e) - (at(2 * h).p_e - at(-2 * h).p_e)) / (12.0 * h);
    CHECK((at(0).v_e - v).norm() < 1e-6);
    const double drift = (at(5).clock_s - at(-5).clock_s) / 10.0;
    CHECK(std::abs(at(0).clock_drift - drift) < 1e-15);
  }
}

// r.v/c^2 from the state's own vectors against the clock's eccentricity term.
TEST_CASE("The clock carries the relativistic term", "[satellite_state]") {
  for (auto c : test::rtklib_broadcast_cases()) {
    c.ephemeris.af0 = c.ephemeris.af1 = c.ephemeris.af2 = 0.0;
    const SatelliteState state =
        broadcast_state(c.ephemeris, c.ephemeris.toe.plus_seconds(c.since_toe_s));
    const double expected = -2.0 * state.p_e.dot(state.v_e) / (kSpeedOfLight * kSpeedOfLight);
    INFO(to_string(c.ephemeris.satellite) << ' ' << expected);
    CHECK(std::abs(state.clock_s - expected) < 1e-10);  // harmonic terms: below 0.1 ns
  }
}

TEST_CASE("The sigma follows the claimed accuracy and grows with age", "[satellite_state]") {
  Ephemeris e = test::rtklib_broadcast_cases().front().ephemeris;
  const auto sigma = [&](double accuracy, double age) {
    e.accuracy_m = accuracy;
    return broadcast_state(e, e.toe.plus_seconds(age)).sigma_m;
  };
  CHECK(sigma(2.0, 0.0) == Approx(2.0));
  CHECK(sigma(2.0, 7200.0) == Approx(std::hypot(2.0, 0.72)));
  CHECK(sigma(0.0, 0.0) > 0.1);     // nobody is perfect
  CHECK(sigma(-1.0, 0.0) >= 10.0);  // no prediction
}

TEST_CASE("Elements that no satellite sends are not sane", "[satellite_state]") {
  const Ephemeris good = test::rtklib_broadcast_cases().front().ephemeris;
  REQUIRE(is_sane(good));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();

  SECTION("a value that is not finite, anywhere") {
    double Ephemeris::*const members[] = {
        &Ephemeris::sqrt_a, &Ephemeris::eccentricity, &Ephemeris::m0,        &Ephemeris::delta_n,
        &Ephemeris::omega0, &Ephemeris::omega_dot,    &Ephemeris::i0,        &Ephemeris::i_dot,
        &Ephemeris::omega,  &Ephemeris::cuc,          &Ephemeris::cus,       &Ephemeris::crc,
        &Ephemeris::crs,    &Ephemeris::cic,          &Ephemeris::cis,       &Ephemeris::af0,
        &Ephemeris::af1,    &Ephemeris::af2,          &Ephemeris::accuracy_m};
    for (std::size_t i = 0; i < std::size(members); ++i) {
      for (const double bad : {nan, inf, -inf, 1e300, -1e300}) {
        Ephemeris e = good;
        e.*members[i] = bad;
        INFO("member " << i << " = " << bad);
        CHECK_FALSE(is_sane(e));
      }
    }
    for (const std::size_t i : {0u, 1u}) {
      Ephemeris e = good;
      e.group_delay_s[i] = nan;
      CHECK_FALSE(is_sane(e));
    }
  }
  SECTION("orbits") {
    Ephemeris e = good;
    for (const double bad : {1.0, 0.2, -1e-9}) {
      e.eccentricity = bad;
      CHECK_FALSE(is_sane(e));
    }
    e = good;
    for (const double bad : {0.0, -5153.7, 2600.0, 7000.0}) {
      e.sqrt_a = bad;
      CHECK_FALSE(is_sane(e));
    }
  }
  SECTION("satellite, message, times") {
    Ephemeris e = good;
    e.satellite.number = 0;
    CHECK_FALSE(is_sane(e));
    e = good;
    e.satellite.system = static_cast<System>(17);
    CHECK_FALSE(is_sane(e));
    e = good;
    e.message = NavigationMessage::kGpsLnav;  // of a BeiDou satellite
    CHECK_FALSE(is_sane(e));
    e = good;
    e.toe = GpsTime();
    CHECK_FALSE(is_sane(e));
    e = good;
    e.toc = e.toe.plus_seconds(90000.0);
    CHECK_FALSE(is_sane(e));
    e = good;
    e.toe = GpsTime::from_nanoseconds(std::numeric_limits<std::int64_t>::min());
    CHECK_FALSE(is_sane(e));
  }
}

TEST_CASE("A LEO satellite flies by Kepler elements too", "[satellite_state]") {
  Ephemeris e;
  e.satellite = {System::kLeo, 150};
  e.toe = e.toc = GpsTime::from_week_and_tow(2200, 345600.0);
  e.sqrt_a = std::sqrt(7.5e6);
  e.eccentricity = 0.001;
  e.i0 = 1.5;
  REQUIRE(is_sane(e));
  const SatelliteState state = broadcast_state(e, e.toe.plus_seconds(100.0));
  CHECK(state.p_e.norm() == Approx(7.5e6).epsilon(0.0011));
  CHECK(state.v_e.norm() == Approx(7.29e3).epsilon(0.02));
  e.sqrt_a = 5153.6;  // GPS's height is not low
  CHECK_FALSE(is_sane(e));
}

// The oracle's own equations, integration and fit: test/oracle/leo_elements.py.
TEST_CASE("Elements with rates follow an integrated low orbit for ten to twenty minutes",
          "[satellite_state]") {
  for (const test::LeoArc& arc : test::leo_arcs()) {
    INFO(arc.name);
    REQUIRE(is_sane(arc.elements));
    double worst_m = 0.0, worst_m_s = 0.0, without_rates_m = 0.0;
    Ephemeris fixed = arc.elements;
    fixed.a_dot = fixed.delta_n_dot = 0.0;
    for (const test::LeoState& state : arc.states) {
      const GpsTime t = arc.elements.toe.plus_seconds(state.since_toe_s);
      const SatelliteState by_elements = broadcast_state(arc.elements, t);
      worst_m = std::max(worst_m, (by_elements.p_e - state.p_e).norm());
      worst_m_s = std::max(worst_m_s, (by_elements.v_e - state.v_e).norm());
      without_rates_m =
          std::max(without_rates_m, (broadcast_state(fixed, t).p_e - state.p_e).norm());
    }
    UNSCOPED_INFO("worst " << worst_m << " m, " << worst_m_s << " m/s");
    // No more than the elements themselves are off, and a micrometre of rounding.
    CHECK(worst_m < 1.01 * arc.worst_m + 1e-5);
    CHECK(worst_m_s < 1.01 * arc.worst_m_s + 1e-6);
    CHECK(worst_m < 0.06);
    CHECK(worst_m_s < 2e-3);
    CHECK(without_rates_m > 1.0);  // the rates are applied
  }
}

TEST_CASE("The velocity of a low satellite is the derivative of its position",
          "[satellite_state]") {
  for (test::LeoArc arc : test::leo_arcs()) {
    INFO(arc.name);
    Ephemeris& e = arc.elements;
    e.a_dot = 5.0, e.delta_n_dot = 1e-9;  // more than fitted: an error of their terms shows
    for (const test::LeoState& state : arc.states) {
      const auto at = [&](double dt) {
        return broadcast_state(e, e.toe.plus_seconds(state.since_toe_s + dt));
      };
      const double h = 0.5;  // s
      const Eigen::Vector3d v =
          (8.0 * (at(h).p_e - at(-h).p_e) - (at(2 * h).p_e - at(-2 * h).p_e)) / (12.0 * h);
      CHECK((at(0).v_e - v).norm() < 1e-6);
    }
  }
}

TEST_CASE("Rates are for LEO satellites and B-CNAV1, and bounded", "[satellite_state]") {
  Ephemeris gps = test::rtklib_broadcast_cases().front().ephemeris;
  Ephemeris leo = test::leo_arcs().front().elements;
  REQUIRE(is_sane(leo));
  for (double Ephemeris::*const rate : {&Ephemeris::a_dot, &Ephemeris::delta_n_dot}) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {nan, 1e300, -100.0}) {
      Ephemeris e = leo;
      e.*rate = bad;
      CHECK_FALSE(is_sane(e));
    }
    Ephemeris e = gps;
    e.*rate = 1e-13;
    CHECK_FALSE(is_sane(e));
    e = gps;
    e.satellite = {System::kBeidou, 21};
    e.message = NavigationMessage::kBeidouD1;
    CHECK(is_sane(e));
    e.*rate = 1e-13;
    CHECK_FALSE(is_sane(e));
    e.message = NavigationMessage::kBeidouCnav1;
    CHECK(is_sane(e));
    e.*rate = 10.0;
    CHECK_FALSE(is_sane(e));
  }
}

}  // namespace leonav
