// Two correction services at once: which one is used, when that changes, and that nothing of one is
// mixed with anything of the other.
#include "tools/import/correction_services.h"

#include "core/gnss/orbits/satellite_state.h"
#include "core/gnss/signals/signal.h"
#include "support/catch.h"

namespace leonav {
namespace {

const GpsTime kTime = GpsTime::from_week_and_tow(2200, 345'600.0);
GpsTime at(double s) { return kTime.plus_seconds(s); }
constexpr SatelliteId kG05{System::kGps, 5}, kE03{System::kGalileo, 3};

Ephemeris elements(SatelliteId id) {
  Ephemeris e;
  e.satellite = id;
  if (id.system == System::kGalileo) e.message = NavigationMessage::kGalileoInav;
  e.toe = e.toc = kTime;
  e.issue = 17;
  e.sqrt_a = 5153.7;
  e.eccentricity = 0.01;
  e.i0 = 0.96;
  return e;
}

SsrMessage message(SsrKind kind, double time_s, SatelliteId id) {
  SsrMessage m;
  m.kind = kind;
  m.system = id.system;
  m.time = at(time_s);
  m.update_interval_s = 1.0;
  m.satellites.emplace_back().satellite = id;
  return m;
}

SsrMessage clock(double time_s, double c0_m, SatelliteId id = kG05) {
  SsrMessage m = message(SsrKind::kOrbitAndClock, time_s, id);
  m.satellites[0].orbit = SsrOrbit{17, {}, {1.0, 2.0, 3.0}, {0.0, 0.0, 0.0}};
  m.satellites[0].clock = SsrClock{c0_m, 0.0, 0.0};
  return m;
}

SsrMessage bias(double time_s, const char* code, double bias_m, SatelliteId id = kG05) {
  SsrMessage m = message(SsrKind::kCodeBias, time_s, id);
  m.satellites[0].code_biases.push_back({*signal_from_string(code), bias_m, false, 0, 0});
  return m;
}

// The first stream's clocks are 1 m off, the second one's 2 m.
struct Rig {
  Rig() : first(services.add_stream("first")), second(services.add_stream("second")) {
    services.add(elements(kG05));
    services.add(elements(kE03));
  }
  // Returns the clock's correction that is published, m; 0: none is.
  double send(std::size_t stream, double time_s, SatelliteId id = kG05) {
    last = services.take(stream, clock(time_s, stream == first ? 1.0 : 2.0, id), at(time_s));
    if (last.states.empty()) return 0.0;
    return kSpeedOfLight *
           (last.states[0].clock_s - broadcast_state(elements(id), at(time_s)).clock_s);
  }
  CorrectionServices services{{}};
  std::size_t first, second;
  CorrectionResult last;
};

constexpr ServiceId kA{0, SsrService::kRtcm}, kB{1, SsrService::kRtcm}, kC{2, SsrService::kRtcm};

}  // namespace

TEST_CASE("of one stream SSR is preferred to HAS and that to PPP-B2b, before all of the next one",
          "[import]") {
  CHECK(ServiceId{0, SsrService::kRtcm} < ServiceId{0, SsrService::kGalileoHas});
  CHECK(ServiceId{0, SsrService::kGalileoHas} < ServiceId{0, SsrService::kBeidouB2b});
  CHECK(ServiceId{0, SsrService::kBeidouB2b} < ServiceId{1, SsrService::kRtcm});
}

TEST_CASE("a service is used until it pauses, and again once it has been there for a while",
          "[import]") {
  ServiceChoice choice({30.0, 60.0});
  CHECK(choice.note(kB, at(0.0))->to == kB);  // the first one to come
  CHECK_FALSE(choice.note(kB, at(10.0)));
  for (double s = 10.0; s < 70.0; s += 10.0) {
    CHECK_FALSE(choice.note(kA, at(s)));
    CHECK_FALSE(choice.note(kB, at(s)));
  }
  const auto preferred = choice.note(kA, at(70.0));
  REQUIRE(preferred);
  CHECK(preferred->from == kB);
  CHECK(preferred->to == kA);
  // A pause up to the limit is none.
  CHECK_FALSE(choice.note(kB, at(100.0)));
  const auto fallback = choice.note(kB, at(100.1));
  REQUIRE(fallback);
  CHECK(fallback->from == kA);
  CHECK(fallback->to == kB);
  CHECK(fallback->pause_s == Approx(30.1));
  // A pause of the preferred one begins its time anew.
  CHECK_FALSE(choice.note(kA, at(110.0)));
  CHECK_FALSE(choice.note(kB, at(130.0)));
  CHECK_FALSE(choice.note(kA, at(145.0)));
  for (double s = 150.0; s < 205.0; s += 10.0) {
    CHECK_FALSE(choice.note(kB, at(s)));
    CHECK_FALSE(choice.note(kA, at(s)));
  }
  CHECK(choice.note(kA, at(205.0))->to == kA);
}

TEST_CASE("of several that may take its place the most preferred one does, whoever comes first",
          "[import]") {
  ServiceChoice choice({30.0, 60.0});
  choice.note(kA, at(0.0));
  choice.note(kB, at(10.0));
  CHECK(choice.note(kC, at(35.0))->to == kB);  // its last state is not old
  CHECK(choice.in_use() == kB);
  CHECK(choice.note(kC, at(41.0))->to == kC);
}

TEST_CASE("a time that steps back leaves no service in use that has paused since", "[import]") {
  ServiceChoice choice({30.0, 60.0});
  choice.note(kA, at(10'000.0));
  CHECK(choice.note(kB, at(0.0))->to == kB);
  CHECK_FALSE(choice.note(kB, at(10.0)));
}

TEST_CASE("clocks of one service alone are published of a system", "[import]") {
  Rig rig;
  CHECK(rig.send(rig.first, 0.0) == Approx(1.0));
  CHECK(rig.last.change->from.empty());
  CHECK(to_text(*rig.last.change) == "corrections of GPS are now those of 'first' (SSR of RTCM)");
  for (double s = 5.0; s < 100.0; s += 5.0) {
    CHECK(rig.send(rig.second, s) == 0.0);
    CHECK(rig.last.is_left_out);
    CHECK(rig.last.usable_states == 1);
    CHECK(rig.send(rig.first, s) == Approx(1.0));
    CHECK_FALSE(rig.last.change);
  }
  CHECK(rig.services.changes() == 0);
  CHECK(rig.services.left_out_states() == 19);
  CHECK(rig.services.systems_of(rig.first) == "GPS");
  CHECK(rig.services.systems_of(rig.second).empty());
  // Another system chooses by itself.
  CHECK(rig.send(rig.second, 100.0, kE03) == Approx(2.0));
  CHECK(rig.send(rig.first, 100.0) == Approx(1.0));
  CHECK(rig.services.systems_of(rig.second) == "Galileo");
}

TEST_CASE("a service that fails gives way to the next one and returns, each told once",
          "[import]") {
  Rig rig;
  rig.send(rig.first, 0.0);
  CHECK(rig.send(rig.second, 25.0) == 0.0);
  CHECK(rig.send(rig.second, 31.0) == Approx(2.0));
  REQUIRE(rig.last.change);
  CHECK_FALSE(rig.last.change->is_return);
  CHECK_THAT(to_text(*rig.last.change),
             Catch::Contains("'second'") &&
                 Catch::Contains("'first' (SSR of RTCM) has given none for 31 s"));
  double s = 40.0;
  for (; s < 100.0; s += 10.0) {
    CHECK(rig.send(rig.first, s) == 0.0);
    CHECK(rig.send(rig.second, s) == Approx(2.0));
    CHECK_FALSE(rig.last.change);
  }
  CHECK(rig.send(rig.first, s) == Approx(1.0));
  REQUIRE(rig.last.change);
  CHECK(rig.last.change->is_return);
  CHECK_THAT(to_text(*rig.last.change), Catch::Contains("preferred to 'second'"));
  CHECK(rig.services.changes() == 2);
}

TEST_CASE("an orbit of one service is not used with a clock of another, in whatever order",
          "[import]") {
  Rig rig;
  SsrMessage orbit = clock(0.0, 0.0);
  orbit.kind = SsrKind::kOrbit;
  orbit.satellites[0].clock.reset();
  SsrMessage alone = clock(0.0, 2.0);
  alone.kind = SsrKind::kClock;
  alone.satellites[0].orbit.reset();
  rig.services.take(rig.first, orbit, at(0.0));
  CHECK(rig.services.take(rig.second, alone, at(0.0)).states.empty());
  CHECK(rig.services.counters(rig.second).without_orbit == 1);
  CHECK(rig.services.counters(rig.first).without_orbit == 0);
  rig.services.take(rig.second, orbit, at(1.0));
  CHECK(rig.services.take(rig.second, alone, at(1.0)).states.size() == 1);
  CHECK(rig.services.counters().states == 1);
}

TEST_CASE("an ephemeris serves services that begin before it and after it", "[import]") {
  CorrectionServices services{{}};
  const std::size_t stream = services.add_stream("a");
  CHECK(services.take(stream, clock(0.0, 1.0), at(0.0)).states.empty());
  services.add(elements(kG05));
  CHECK(services.take(stream, clock(1.0, 1.0), at(1.0)).states.size() == 1);
  SsrMessage igs = clock(2.0, 1.0);
  igs.service = SsrService::kIgs;
  CHECK(services.take(stream, igs, at(2.0)).usable_states == 1);
  CHECK(services.services() == 2);
}

TEST_CASE("biases come with the states that they belong to, and end with them", "[import]") {
  Rig rig;
  // Before a service is in use its biases wait.
  CHECK(rig.services.take(rig.first, bias(0.0, "1C", 0.5), at(0.0)).biases.empty());
  rig.services.take(rig.first, bias(0.0, "2W", 0.6), at(0.0));
  rig.services.take(rig.second, bias(0.0, "1C", 0.7), at(0.0));
  rig.services.take(rig.second, bias(0.0, "1C", 0.8, kE03), at(0.0));
  rig.send(rig.first, 1.0);
  REQUIRE(rig.last.biases.size() == 2);
  CHECK(rig.last.biases[0].bias_m == -0.5);
  CHECK(rig.last.biases[0].time == at(1.0));
  const auto later = rig.services.take(rig.first, bias(2.0, "5Q", 0.9), at(2.0));
  REQUIRE(later.biases.size() == 1);
  const auto other = rig.services.take(rig.second, bias(2.0, "1C", 1.0), at(2.0));
  CHECK(other.biases.empty());
  CHECK_FALSE(other.is_left_out);
  // The second one gives no 2W and no 5Q: those of the first one end.
  rig.send(rig.second, 40.0);
  REQUIRE(rig.last.change);
  REQUIRE(rig.last.biases.size() == 3);
  SignalBiasStore store;
  for (const SignalBias& b : later.biases) CHECK(store.add(b));
  CHECK(store.code_delay(kG05, at(39.0), *signal_from_string("5Q")));
  for (const SignalBias& b : rig.last.biases) CHECK(store.add(b));
  CHECK(store.code_delay(kG05, at(40.0), *signal_from_string("1C"))->delay_m == -1.0);
  CHECK_FALSE(store.code_delay(kG05, at(40.0), *signal_from_string("2W")));
  CHECK_FALSE(store.code_delay(kG05, at(40.0), *signal_from_string("5Q")));
}

}  // namespace leonav
