// Which corrections make states: issues, ages, frames, providers; and by how much they move them.
#include "drivers/ssr/correction_store.h"

#include <Eigen/Geometry>
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
  CHECK(is_corrected_by(elements(kG05, 0x34), orbit, false));
  CHECK_FALSE(is_corrected_by(elements(kG05, 0x35), orbit, false));
  const SatelliteId galileo{System::kGalileo, 3};
  CHECK_FALSE(is_corrected_by(elements(galileo, 0x134), orbit, false));
  CHECK(is_corrected_by(elements(galileo, 0x134), orbit, true));
  orbit.issue = 0x134;
  CHECK(is_corrected_by(elements(galileo, 0x134), orbit, false));
  // toe 345600 s of GPS is 345586 s of BeiDou; 345614 is 345600, a whole hour.
  const SatelliteId beidou{System::kBeidou, 20};
  orbit.issue = 345'600 / 720 % 240;
  CHECK(is_corrected_by(elements(beidou, 1, 14.0), orbit, true));
  CHECK_FALSE(is_corrected_by(elements(beidou, 1, 14.0 + 3600.0), orbit, true));
  orbit.beidou_toe = 345'600 / 8 % 1024;
  CHECK(is_corrected_by(elements(beidou, 1, 14.0), orbit, false));
  CHECK_FALSE(is_corrected_by(elements(beidou, 1, 14.0 + 3600.0), orbit, false));
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

TEST_CASE("Biases are turned to what is subtracted") {
  SsrMessage m = message(SsrKind::kCodeBias, 0.0);
  m.satellites[0].code_biases.push_back({{'1', 'C'}, 1.5});
  m.satellites[0].code_biases.push_back({{'9', 'C'}, 1.5});  // no band of GPS
  const auto biases = biases_of(m, kTime);
  REQUIRE(biases.size() == 1);
  CHECK(biases[0].bias_m == -1.5);
  CHECK(biases[0].kind == BiasKind::kCode);
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
