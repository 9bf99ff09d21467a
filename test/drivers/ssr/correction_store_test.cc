// Which corrections make states: issues, ages, frames, providers; and by how much they move them.
#include "drivers/ssr/correction_store.h"

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/gnss/orbits/satellite_state.h"
#include "core/gnss/signals/signal.h"
#include "drivers/ssr/accuracy.h"
#include "support/catch.h"

namespace leonav {
namespace {

const GpsTime kTime = GpsTime::from_week_and_tow(2200, 345'600.0);
constexpr SatelliteId kG05{System::kGps, 5};

Ephemeris elements(SatelliteId id, std::uint16_t issue, double toe_s = 0.0) {
  Ephemeris e;
  e.satellite = id;
  if (id.system == System::kGalileo) e.message = NavigationMessage::kGalileoInav;
  if (id.system == System::kBeidou) e.message = NavigationMessage::kBeidouD1;
  e.toe = e.toc = kTime.plus_seconds(toe_s);
  e.issue = issue;
  e.sqrt_a = 5153.7;
  e.eccentricity = 0.01;
  e.i0 = 0.96;
  e.m0 = 0.4;
  e.af0 = 1e-4 + 1e-8 * issue;  // another clock with every issue
  return e;
}

SsrMessage message(SsrKind kind, double time_s, SatelliteId id = kG05) {
  SsrMessage m;
  m.kind = kind;
  m.system = id.system;
  m.time = kTime.plus_seconds(time_s);
  m.update_interval_s = 1.0;
  m.provider = 7;
  m.satellites.emplace_back().satellite = id;
  return m;
}

SsrMessage orbit(double time_s, std::uint16_t issue, SatelliteId id = kG05) {
  SsrMessage m = message(SsrKind::kOrbit, time_s, id);
  m.satellites[0].orbit = SsrOrbit{issue, {}, {1.0, 2.0, 3.0}, {0.0, 0.0, 0.0}};
  return m;
}

SsrMessage clock(double time_s, double c0_m = 0.5, SatelliteId id = kG05) {
  SsrMessage m = message(SsrKind::kClock, time_s, id);
  m.satellites[0].clock = SsrClock{c0_m, 0.0, 0.0};
  return m;
}

// Number of states that a clock makes, sent and used at `time_s`.
std::size_t states_at(CorrectionStore* store, double time_s) {
  const SsrMessage m = clock(time_s);
  store->add(m);
  return store->states(m, kTime.plus_seconds(time_s)).size();
}

}  // namespace

TEST_CASE("Accuracy indices are those of the table of DF389") {
  CHECK_FALSE(ssr_accuracy_m(0));
  CHECK(*ssr_accuracy_m(1) == Approx(0.25e-3));
  CHECK(*ssr_accuracy_m(7) == Approx(1.75e-3));
  CHECK(*ssr_accuracy_m(8) == Approx(2e-3));
  CHECK(*ssr_accuracy_m(37) == Approx(0.18125));  // 81 (1 + 5/4) - 1 = 181.25
  CHECK(*ssr_accuracy_m(62) == Approx(5.4665));
  CHECK_FALSE(ssr_accuracy_m(63));
}

TEST_CASE("A correction moves the broadcast state along its own axes") {
  CorrectionStore store;
  store.add(elements(kG05, 17));
  store.add(orbit(0.0, 17));
  SsrMessage m = clock(0.0);
  m.satellites[0].clock = SsrClock{0.5, 0.01, 0.001};
  store.add(m);
  const auto states = store.states(m, kTime.plus_seconds(10.0));
  REQUIRE(states.size() == 1);
  const SatelliteState broadcast = broadcast_state(elements(kG05, 17), kTime.plus_seconds(10.0));
  const Eigen::Vector3d moved = broadcast.p_e - states[0].p_e;
  CHECK(moved.norm() == Approx(std::sqrt(14.0)));
  CHECK(moved.dot(broadcast.v_e.normalized()) == Approx(2.0));
  CHECK(moved.dot(broadcast.p_e.cross(broadcast.v_e).normalized()) == Approx(3.0));
  CHECK(moved.dot(broadcast.p_e.normalized()) == Approx(1.0).margin(0.05));
  CHECK(kSpeedOfLight * (states[0].clock_s - broadcast.clock_s) == Approx(0.5 + 0.1 + 0.1));
  CHECK(kSpeedOfLight * (states[0].clock_drift - broadcast.clock_drift) == Approx(0.03));
  CHECK(states[0].sigma_m == Approx(CorrectionOptions().default_sigma_m));
  CHECK(states[0].issue == 17);
  CHECK(states[0].at_antenna);
}

TEST_CASE("The velocity is the derivative of the position") {
  CorrectionStore store;
  store.add(elements(kG05, 17));
  SsrMessage m = orbit(0.0, 17);
  m.satellites[0].orbit->delta_rate_rac = {0.01, -0.02, 0.03};
  store.add(m);
  const SsrMessage c = clock(0.0);
  store.add(c);
  const auto at = [&](double s) { return store.states(c, kTime.plus_seconds(s)).at(0); };
  // 1e-8 m are the rounding of the positions, 1e-4 m/s^3 their third derivative.
  const Eigen::Vector3d difference = (at(20.01).p_e - at(19.99).p_e) / 0.02;
  CHECK((difference - at(20.0).v_e).norm() < 5e-6);
}

TEST_CASE("A correction waits for its broadcast message and is never mixed with another") {
  CorrectionStore store;
  store.add(elements(kG05, 16));
  store.add(orbit(0.0, 17));
  CHECK(states_at(&store, 0.0) == 0);
  CHECK(store.counters().without_ephemeris == 1);
  store.add(elements(kG05, 17));
  CHECK(states_at(&store, 5.0) == 1);
  // The number returns; the elements of a day before are not those.
  CorrectionStore other;
  other.add(elements(kG05, 17, -86'400.0));
  other.add(orbit(0.0, 17));
  CHECK(states_at(&other, 0.0) == 0);
  // A clock of the issue before does not go with the new one.
  store.add(elements(kG05, 18));
  store.add(orbit(10.0, 18));
  const SsrMessage late = clock(5.0);
  CHECK(store.states(late, kTime.plus_seconds(10.0)).empty());
  CHECK(store.counters().without_clock == 1);
  CHECK(states_at(&store, 10.0) == 1);
}

TEST_CASE("Issues are those of each system") {
  SsrOrbit orbit;
  orbit.issue = 0x34;
  CHECK(is_corrected_by(elements(kG05, 0x34), orbit, SsrService::kRtcm));
  CHECK_FALSE(is_corrected_by(elements(kG05, 0x35), orbit, SsrService::kRtcm));
  const SatelliteId galileo{System::kGalileo, 3};
  CHECK_FALSE(is_corrected_by(elements(galileo, 0x134), orbit, SsrService::kRtcm));
  CHECK(is_corrected_by(elements(galileo, 0x134), orbit, SsrService::kIgs));
  orbit.issue = 0x134;
  CHECK(is_corrected_by(elements(galileo, 0x134), orbit, SsrService::kRtcm));
  // toe 345600 s of GPS is 345586 s of BeiDou; 345614 is 345600, a whole hour.
  const SatelliteId beidou{System::kBeidou, 20};
  orbit.issue = 345'600 / 720 % 240;
  CHECK(is_corrected_by(elements(beidou, 1, 14.0), orbit, SsrService::kIgs));
  CHECK_FALSE(is_corrected_by(elements(beidou, 1, 14.0 + 3600.0), orbit, SsrService::kIgs));
  orbit.beidou_toe = 345'600 / 8 % 1024;
  CHECK(is_corrected_by(elements(beidou, 1, 14.0), orbit, SsrService::kRtcm));
  CHECK_FALSE(is_corrected_by(elements(beidou, 1, 14.0 + 3600.0), orbit, SsrService::kRtcm));
}

TEST_CASE("Old corrections, other solutions and regional frames make no states") {
  const CorrectionOptions options;
  CorrectionStore store(options);
  store.add(elements(kG05, 17));
  CHECK(states_at(&store, 0.0) == 0);
  CHECK(store.counters().without_orbit == 1);
  store.add(orbit(0.0, 17));
  CHECK(states_at(&store, options.max_orbit_age_s) == 1);
  CHECK(states_at(&store, options.max_orbit_age_s + 1.0) == 0);
  const SsrMessage m = clock(0.0);
  store.add(m);
  CHECK(store.states(m, kTime.plus_seconds(options.max_clock_age_s)).size() == 1);
  CHECK(store.states(m, kTime.plus_seconds(options.max_clock_age_s + 1.0)).empty());
  CHECK(store.counters().too_old == 2);
  SsrMessage other = clock(0.0);
  other.issue = 3;
  store.add(other);
  CHECK(store.states(other, kTime).empty());
  CHECK(store.counters().of_other_issue == 1);
  store.add(clock(0.0));
  SsrMessage regional = orbit(0.0, 17);
  regional.is_regional_frame = true;
  regional.satellites[0].orbit->delta_rac_m.x() = 100.0;
  store.add(regional);
  CHECK(store.counters().in_regional_frame == 1);
  CHECK(states_at(&store, 0.0) == 1);
}

TEST_CASE("Reference times, accuracies and high-rate clocks are taken") {
  CorrectionStore store;
  store.add(elements(kG05, 17));
  SsrMessage m = orbit(0.0, 17);
  m.update_interval_s = 60.0;
  m.satellites[0].orbit->delta_rate_rac = {0.0, 1.0, 0.0};
  store.add(m);
  SsrMessage c = clock(0.0);
  c.update_interval_s = 10.0;
  c.satellites[0].clock->c1 = 0.1;
  store.add(c);
  SsrMessage ura = message(SsrKind::kAccuracy, 0.0);
  ura.satellites[0].accuracy_index = 37;
  store.add(ura);
  const auto one = store.states(c, kTime.plus_seconds(30.0)).at(0);
  CHECK(one.orbit_corrected_at == kTime.plus_seconds(30.0));
  CHECK(one.corrected_at == kTime.plus_seconds(5.0));
  CHECK(one.sigma_m == Approx(0.18125));
  ura.satellites[0].accuracy_index = kWorstSsrAccuracy;
  store.add(ura);
  CHECK(store.states(c, kTime.plus_seconds(30.0)).empty());
  CHECK(store.counters().not_reliable == 1);
  ura.satellites[0].accuracy_index = 37;
  store.add(ura);
  SsrMessage rapid = message(SsrKind::kHighRateClock, 28.0);
  rapid.satellites[0].high_rate_clock_m = 0.25;
  store.add(rapid);
  const auto two = store.states(rapid, kTime.plus_seconds(30.0)).at(0);
  CHECK(kSpeedOfLight * (two.clock_s - one.clock_s) == Approx(0.25).margin(1e-6));
  CHECK(two.corrected_at == kTime.plus_seconds(28.0));
  // It ends with the next clock, and with its age.
  CHECK(store.states(rapid, kTime.plus_seconds(45.0)).at(0).corrected_at ==
        kTime.plus_seconds(5.0));
}

TEST_CASE(
    "A high-rate clock sent with or after its clock is added all through the clock's interval") {
  CorrectionStore store;
  store.add(elements(kG05, 17));
  store.add(orbit(0.0, 17));
  const auto rapid_at = [&](double time_s, std::uint8_t issue = 0) {
    SsrMessage rapid = message(SsrKind::kHighRateClock, time_s);
    rapid.issue = issue;
    rapid.satellites[0].high_rate_clock_m = 0.5;
    store.add(rapid);
    return rapid;
  };
  const auto clock_m = [&](const SsrMessage& m, double time_s) {
    const GpsTime time = kTime.plus_seconds(time_s);
    const auto states = store.states(m, time);
    REQUIRE(states.size() == 1);
    return kSpeedOfLight * (states[0].clock_s - broadcast_state(elements(kG05, 17), time).clock_s);
  };
  SsrMessage c = clock(0.0, 1.0);
  c.update_interval_s = 30.0;  // its reference time is 15 s
  store.add(c);
  for (const double time_s : {0.0, 1.0, 14.0, 15.0, 29.0}) {
    CAPTURE(time_s);
    const SsrMessage rapid = rapid_at(time_s);
    CHECK(clock_m(rapid, time_s) == Approx(1.5).margin(1e-6));
  }
  // It was made for the clock before, and says nothing of the next one.
  c.time = kTime.plus_seconds(30.0);
  store.add(c);
  CHECK(clock_m(c, 30.0) == Approx(1.0).margin(1e-6));
  CHECK(clock_m(rapid_at(31.0), 31.0) == Approx(1.5).margin(1e-6));
  // Nor is one of another solution added.
  CHECK(clock_m(rapid_at(32.0, 3), 32.0) == Approx(1.0).margin(1e-6));
}

TEST_CASE("Corrections that say for how long they hold, and of which point, are believed") {
  CorrectionStore store;
  store.add(elements(kG05, 17));
  SsrMessage o = orbit(0.0, 17), c = clock(0.0);
  for (SsrMessage* m : {&o, &c}) {
    m->service = SsrService::kGalileoHas;
    m->at_antenna = false;
  }
  o.validity_s = 300.0;
  c.validity_s = 20.0;
  store.add(o);
  store.add(c);
  CHECK(store.states(c, kTime.plus_seconds(21.0)).empty());
  const auto states = store.states(c, kTime.plus_seconds(20.0));
  REQUIRE(states.size() == 1);
  CHECK_FALSE(states[0].at_antenna);
  SsrMessage later = c;
  later.time = kTime.plus_seconds(290.0);
  store.add(later);
  CHECK(store.states(later, kTime.plus_seconds(300.0)).size() == 1);
  CHECK(store.states(later, kTime.plus_seconds(301.0)).empty());
  CHECK(store.counters().too_old == 2);
}

TEST_CASE("A correction that is not available any more ends the one before") {
  CorrectionStore store;
  store.add(elements(kG05, 17));
  store.add(orbit(0.0, 17));
  CHECK(states_at(&store, 0.0) == 1);
  SsrMessage no_clock = clock(10.0);
  no_clock.satellites[0].clock.reset();
  no_clock.satellites[0].clock_ends = true;
  store.add(no_clock);
  CHECK(store.states(no_clock, kTime.plus_seconds(10.0)).empty());
  CHECK(store.counters().without_clock == 1);
  SsrMessage no_orbit = orbit(20.0, 17);
  no_orbit.satellites[0].orbit.reset();
  no_orbit.satellites[0].orbit_ends = true;
  store.add(no_orbit);
  CHECK(states_at(&store, 20.0) == 0);
  CHECK(store.counters().without_orbit == 1);
}

TEST_CASE("Orbits of one service are not used with clocks of another") {
  CorrectionStore store;
  store.add(elements(kG05, 17));
  SsrMessage o = orbit(0.0, 17);
  o.service = SsrService::kGalileoHas;
  store.add(o);
  CHECK(states_at(&store, 0.0) == 0);
  CHECK(store.counters().of_other_issue == 1);
}

TEST_CASE("HAS and PPP-B2b refer to I/NAV, and PPP-B2b to BeiDou's B-CNAV1 alone") {
  const SatelliteId galileo{System::kGalileo, 3}, beidou{System::kBeidou, 20};
  SsrOrbit of;
  of.issue = 5;
  Ephemeris fnav = elements(galileo, 5);
  fnav.message = NavigationMessage::kGalileoFnav;
  for (const SsrService service : {SsrService::kGalileoHas, SsrService::kBeidouB2b}) {
    CHECK(is_corrected_by(elements(galileo, 5), of, service));
    CHECK_FALSE(is_corrected_by(elements(galileo, 0x105), of, service));
    CHECK_FALSE(is_corrected_by(fnav, of, service));
    CHECK_FALSE(is_corrected_by(elements(beidou, 5), of, service));
  }
  CHECK(is_corrected_by(fnav, of, SsrService::kRtcm));
  Ephemeris bcnav1 = elements(beidou, 5);
  bcnav1.message = NavigationMessage::kBeidouCnav1;
  bcnav1.m0 += 1e-5;
  CHECK(is_corrected_by(bcnav1, of, SsrService::kBeidouB2b));
  SsrOrbit of_toe = of;
  of_toe.beidou_toe =
      static_cast<std::uint16_t>(std::lround((bcnav1.toe.tow_s() - 14.0) / 8.0)) % 1024;
  CHECK(is_corrected_by(elements(beidou, 5), of_toe, SsrService::kRtcm));
  CHECK_FALSE(is_corrected_by(bcnav1, of_toe, SsrService::kRtcm));
  CorrectionStore store;
  store.add(elements(beidou, 5));
  SsrMessage o = orbit(0.0, 5, beidou), c = clock(0.0, 0.5, beidou);
  o.service = c.service = SsrService::kBeidouB2b;
  store.add(o);
  store.add(c);
  CHECK(store.states(c, kTime).empty());
  CHECK(store.counters().without_bcnav1 == 1);
  CHECK(store.counters().without_ephemeris == 0);
  // A set of D1 with the same issue and reference time stays beside it.
  store.add(bcnav1);
  store.add(elements(beidou, 5));
  const auto states = store.states(c, kTime);
  REQUIRE(states.size() == 1);
  const double distance_m = (states[0].p_e - broadcast_state(bcnav1, kTime).p_e).norm();
  CHECK(distance_m == Approx(std::sqrt(14.0)));
  CHECK((states[0].p_e - broadcast_state(elements(beidou, 5), kTime).p_e).norm() > 100.0);
}

TEST_CASE(
    "Of PPP-B2b orbit and clock share the IOD Corr, and the clock before waits for its orbit") {
  CorrectionStore store;
  store.add(elements(kG05, 17));
  const auto b2b = [](SsrMessage m, std::uint8_t issue) {
    m.service = SsrService::kBeidouB2b;
    if (m.satellites[0].orbit) {
      m.satellites[0].orbit->correction_issue = issue;
      m.satellites[0].orbit->axes = OrbitAxes::kRadial;
    }
    if (m.satellites[0].clock) m.satellites[0].clock->correction_issue = issue;
    return m;
  };
  const auto clock_at = [&](double time_s) {
    const auto states = store.states(clock(time_s), kTime.plus_seconds(time_s));
    const double broadcast =
        broadcast_state(elements(kG05, 17), kTime.plus_seconds(time_s)).clock_s;
    return states.empty() ? 0.0 : kSpeedOfLight * (states[0].clock_s - broadcast);
  };
  store.add(b2b(orbit(0.0, 17), 1));
  store.add(b2b(clock(0.0, 0.5), 1));
  CHECK(clock_at(0.0) == Approx(0.5).margin(1e-6));
  store.add(b2b(clock(6.0, 0.7), 2));  // before the orbit that it belongs to
  CHECK(clock_at(6.0) == Approx(0.5).margin(1e-6));
  store.add(b2b(clock(12.0, 0.8), 2));
  CHECK(clock_at(12.0) == Approx(0.5).margin(1e-6));
  store.add(b2b(orbit(10.0, 17), 2));
  CHECK(clock_at(12.0) == Approx(0.8).margin(1e-6));
  store.add(b2b(orbit(20.0, 17), 3));
  CHECK(clock_at(20.0) == 0.0);
  CHECK(store.counters().of_other_issue == 1);
  // Its axes are those of the radius: what is radial has no part along track.
  SsrMessage radial = b2b(orbit(20.0, 17), 2);
  radial.satellites[0].orbit->delta_rac_m = {1.0, 0.0, 0.0};
  store.add(radial);
  const auto states = store.states(clock(20.0), kTime.plus_seconds(20.0));
  REQUIRE(states.size() == 1);
  const SatelliteState broadcast = broadcast_state(elements(kG05, 17), kTime.plus_seconds(20.0));
  CHECK((broadcast.p_e - broadcast.p_e.normalized() - states[0].p_e).norm() < 1e-6);
}

TEST_CASE("Biases are turned to what is subtracted") {
  SsrMessage m = message(SsrKind::kCodeBias, 0.0);
  m.satellites[0].code_biases.push_back({{'1', 'C'}, 1.5});
  m.satellites[0].code_biases.push_back({{'9', 'C'}, 1.5});  // no band of GPS
  const auto biases = biases_of(m, kTime);
  REQUIRE(biases.size() == 1);
  CHECK(biases[0].bias_m == -1.5);
  CHECK(biases[0].kind == BiasKind::kCode);
}

TEST_CASE("The L2 P bias of GPS in HAS is that of P(Y) too, and the pair 1C/2W has its delay") {
  SsrMessage m = message(SsrKind::kCodeBias, 0.0);
  m.service = SsrService::kGalileoHas;
  m.satellites[0].code_biases = {{{'1', 'C'}, -3.36}, {{'2', 'L'}, -5.4}, {{'2', 'P'}, -5.54}};
  SignalBiasStore has;
  for (const SignalBias& bias : biases_of(m, kTime)) CHECK(has.add(bias));
  const auto single = has.code_delay(kG05, kTime, {'2', 'W'});
  REQUIRE(single);
  CHECK(single->delay_m == Approx(5.54));
  const auto pair = has.code_delay(kG05, kTime, {'1', 'C'}, {'2', 'W'});
  REQUIRE(pair);
  const double squares = std::pow(1575.42 / 1227.60, 2);
  CHECK(pair->delay_m == Approx((squares * 3.36 - 5.54) / (squares - 1.0)));
  m.satellites[0].phase_biases = {{{'2', 'P'}, 0.1}};
  CHECK(biases_of(m, kTime).size() == 6);
  // Others have numbers of their own for P and P(Y), and other systems no P(Y).
  m.satellites[0].phase_biases.clear();
  m.service = SsrService::kIgs;
  CHECK(biases_of(m, kTime).size() == 3);
  m.service = SsrService::kGalileoHas;
  m.satellites[0].satellite = {System::kBeidou, 20};
  m.satellites[0].code_biases = {{{'1', 'P'}, 1.0}};
  CHECK(biases_of(m, kTime).size() == 1);
}

TEST_CASE("Any satellites and times in any order make valid states or none") {
  std::mt19937 random(3);
  CorrectionStore store;
  for (int i = 0; i < 20'000; ++i) {
    const SatelliteId id{static_cast<System>(random() % 5),
                         static_cast<std::uint16_t>(random() % 70)};
    const auto issue = static_cast<std::uint16_t>(random() % 4);
    const double time_s = static_cast<double>(random() % 1000) - 500.0;
    if (is_valid(id)) store.add(elements(id, issue, time_s));
    const SsrMessage m = random() % 2 != 0 ? orbit(time_s, issue, id) : clock(time_s, 0.1, id);
    store.add(m);
    for (const CorrectedState& state : store.states(m, kTime)) {
      REQUIRE(is_valid(state.satellite));
      REQUIRE(state.p_e.allFinite());
    }
  }
}

}  // namespace leonav
