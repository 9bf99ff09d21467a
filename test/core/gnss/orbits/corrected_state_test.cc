// A corrected state carried on, and its place among the products of the store.
#include "core/gnss/orbits/corrected_state.h"

#include "core/gnss/orbits/ephemeris_store.h"
#include "core/gnss/signals/signal.h"
#include "gps_5_at_noon.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::kNoon;

// GPS 29 of 2023-08-17, whose message follows the real forces to a metre over hours.
Ephemeris real_elements() {
  Ephemeris e;
  e.satellite = {System::kGps, 29};
  e.toe = e.toc = GpsTime::from_week_and_tow(2275, 360'000.0);
  e.transmission_time = e.toe.plus_seconds(-7200.0);
  e.issue = 52;
  e.af0 = -.607899390161e-03;
  e.af1 = -.682121026330e-12;
  e.crs = .412500000000e+01;
  e.delta_n = .395802201036e-08;
  e.m0 = -.376145047425e+00;
  e.cuc = .169500708580e-06;
  e.eccentricity = .263473694213e-02;
  e.cus = .116378068924e-04;
  e.sqrt_a = .515372894669e+04;
  e.cic = -.298023223877e-07;
  e.omega0 = -.983036037682e-01;
  e.cis = -.726431608200e-07;
  e.i0 = .975725699989e+00;
  e.crc = .163812500000e+03;
  e.omega = .252285348249e+01;
  e.omega_dot = -.765674750570e-08;
  e.i_dot = -.534665128092e-09;
  e.accuracy_m = 2.0;
  return e;
}

CorrectedState state_of(const Ephemeris& e, GpsTime time) {
  const SatelliteState from = broadcast_state(e, time);
  CorrectedState state;
  state.satellite = e.satellite;
  state.time = state.corrected_at = state.orbit_corrected_at = time;
  state.issue = e.issue;
  state.p_e = from.p_e;
  state.v_e = from.v_e;
  state.clock_s = from.clock_s;
  state.clock_drift = from.clock_drift;
  state.sigma_m = 0.05;
  return state;
}

}  // namespace

TEST_CASE("A state is carried on for seconds to millimetres", "[corrected_state]") {
  const Ephemeris e = real_elements();
  for (double begin = -3600.0; begin <= 3600.0; begin += 600.0) {
    const GpsTime from = e.toe.plus_seconds(begin);
    for (const double dt : {-20.0, -1.0, 0.0, 5.0, 20.0, 60.0}) {
      const SatelliteState truth = broadcast_state(e, from.plus_seconds(dt));
      const SatelliteState carried = carried_state(state_of(e, from), from.plus_seconds(dt));
      // Half of 1e-5 m/s^2 times dt^2, and the elements' own deviation from the real forces.
      const double limit = 0.5e-5 * dt * dt + 2e-6 * std::abs(dt) + 1e-6;
      CHECK((carried.p_e - truth.p_e).norm() < limit);
      CHECK((carried.v_e - truth.v_e).norm() < 1e-5 * std::abs(dt) + 2e-6);
      CHECK(kSpeedOfLight * std::abs(carried.clock_s - truth.clock_s) < 1e-3);
    }
  }
}

TEST_CASE("Sigma and age grow from the clock's correction", "[corrected_state]") {
  CorrectedState state = state_of(real_elements(), real_elements().toe);
  state.corrected_at = state.time.plus_seconds(-10.0);
  const SatelliteState carried = carried_state(state, state.time.plus_seconds(15.0));
  CHECK(carried.age_s == Approx(25.0));
  CHECK(carried.sigma_change_m == Approx(3.6e-3 * 5.0));
  CHECK(carried.sigma_m == Approx(std::hypot(0.05, 3.6e-3 * 5.0)));
}

TEST_CASE("A corrected state serves while it is young, then the broadcast elements",
          "[satellite_catalog]") {
  const Ephemeris e = real_elements();
  EphemerisStore store{EphemerisConfig{}};
  REQUIRE(store.add(e));
  CorrectedState corrected = state_of(e, e.toe);
  corrected.p_e += corrected.p_e.normalized();
  REQUIRE(store.add(corrected));
  SatelliteState state;
  const Ephemeris* used = nullptr;
  REQUIRE(store.state_at(e.satellite, e.toe.plus_seconds(59.0), &state, &used) ==
          LookupStatus::kOk);
  CHECK(state.source == OrbitSource::kPrecise);
  CHECK(state.at_antenna);
  CHECK(used == nullptr);
  CHECK((state.p_e - broadcast_state(e, e.toe.plus_seconds(59.0)).p_e).norm() ==
        Approx(1.0).margin(0.05));
  REQUIRE(store.state_at(e.satellite, e.toe.plus_seconds(61.0), &state, &used) ==
          LookupStatus::kOk);
  CHECK(state.source == OrbitSource::kBroadcast);
  // A new one replaces it, whatever its time, so that a wrong time blocks nothing.
  corrected.time = corrected.corrected_at = e.toe.plus_seconds(1e6);
  REQUIRE(store.add(corrected));
  REQUIRE(store.state_at(e.satellite, e.toe, &state, &used) == LookupStatus::kOk);
  CHECK(state.source == OrbitSource::kBroadcast);
  corrected.time = corrected.corrected_at = e.toe;
  REQUIRE(store.add(corrected));
  REQUIRE(store.state_at(e.satellite, e.toe, &state) == LookupStatus::kOk);
  CHECK(state.source == OrbitSource::kPrecise);
}

TEST_CASE("Corrected states that no satellite can have are refused", "[satellite_catalog]") {
  const CorrectedState good = state_of(real_elements(), kNoon);
  EphemerisStore store{EphemerisConfig{}};
  const auto refused = [&](auto change) {
    CorrectedState bad = good;
    change(&bad);
    return !store.add(bad);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(refused([](CorrectedState* s) { s->satellite.number = 0; }));
  CHECK(refused([](CorrectedState* s) { s->time = GpsTime(); }));
  CHECK(refused([](CorrectedState* s) { s->corrected_at = GpsTime(); }));
  CHECK(refused([](CorrectedState* s) { s->p_e *= 10.0; }));
  CHECK(refused([](CorrectedState* s) { s->v_e *= 10.0; }));
  CHECK(refused([&](CorrectedState* s) { s->p_e.x() = nan; }));
  CHECK(refused([&](CorrectedState* s) { s->clock_s = nan; }));
  CHECK(refused([](CorrectedState* s) { s->clock_drift = 1.0; }));
  CHECK(refused([](CorrectedState* s) { s->sigma_m = 0.0; }));
}

}  // namespace leonav
